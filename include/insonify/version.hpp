// The version: three numbers, read by CMake too, and nothing else.
#pragma once

#define INSONIFY_VERSION_MAJOR 0
#define INSONIFY_VERSION_MINOR 1
#define INSONIFY_VERSION_PATCH 0
