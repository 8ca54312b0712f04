// The second translation unit of every test program: whatever a header defines without `inline` collides at link time.
#include <insonify/all.hpp>
