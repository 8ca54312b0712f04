// Includes every seabed model of the library.
#pragma once

#include <insonify/seabed/blend.hpp>
#include <insonify/seabed/detailed.hpp>
#include <insonify/seabed/flat.hpp>
#include <insonify/seabed/heightfield.hpp>
#include <insonify/seabed/mixed.hpp>
#include <insonify/seabed/mud.hpp>
#include <insonify/seabed/none.hpp>
#include <insonify/seabed/ripples.hpp>
#include <insonify/seabed/rock.hpp>
#include <insonify/seabed/sculpt.hpp>
#include <insonify/seabed/sediment.hpp>
