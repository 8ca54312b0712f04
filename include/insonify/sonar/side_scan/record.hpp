// Side-scan pictures: pings by ranges, with the water column, the first return, layover and shadows, and labels for
// every bin. In the compiled form, include this header to record with a law of your own.
#pragma once

#include <insonify/sonar/side_scan/detail/recorder.hpp>
#include <insonify/sonar/side_scan/recording.hpp>
