// Version numbers. CMake reads them from this file.
#pragma once

#define INSONIFY_VERSION_MAJOR 0
#define INSONIFY_VERSION_MINOR 1
#define INSONIFY_VERSION_PATCH 0
