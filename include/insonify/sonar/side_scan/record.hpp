// Side-scan pictures: pings by ranges, with the water column, the first return, layover and shadows, and labels for
// every bin. Laws of your own need this header in the compiled form.
#pragma once

#include <insonify/sonar/side_scan/detail/recorder.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
