// Umbrella header: scenes of targets on a seabed, overhead pictures of them, and filters. The same in both forms (see
// compiled.hpp).
//
// Everything else (side-scan recordings, further objects and seabeds, `draw`, custom shadow policies) is in headers to
// include by name, so that programs that don't use it don't compile it. all.hpp includes almost all of them.
#pragma once

#include <insonify/config.hpp>
#include <insonify/core/context.hpp>
#include <insonify/core/error.hpp>
#include <insonify/core/executor.hpp>
#include <insonify/core/image.hpp>
#include <insonify/core/image_view.hpp>
#include <insonify/core/linear.hpp>
#include <insonify/core/numeric.hpp>
#include <insonify/core/quantize.hpp>
#include <insonify/core/random.hpp>
#include <insonify/core/rect.hpp>
#include <insonify/core/simd/dispatch.hpp>
#include <insonify/filter/colormap.hpp>
#include <insonify/filter/concept.hpp>
#include <insonify/filter/convert.hpp>
#include <insonify/filter/echo_noise.hpp>
#include <insonify/filter/gray.hpp>
#include <insonify/filter/histogram.hpp>
#include <insonify/filter/match.hpp>
#include <insonify/filter/noise.hpp>
#include <insonify/filter/parameter.hpp>
#include <insonify/filter/pipe.hpp>
#include <insonify/filter/where.hpp>
#include <insonify/fwd.hpp>
#include <insonify/geometry/camera.hpp>
#include <insonify/geometry/cone.hpp>
#include <insonify/geometry/cube.hpp>
#include <insonify/geometry/cylinder.hpp>
#include <insonify/geometry/mesh.hpp>
#include <insonify/geometry/shared_mesh.hpp>
#include <insonify/geometry/sphere.hpp>
#include <insonify/geometry/surface_kind.hpp>
#include <insonify/geometry/transform.hpp>
#include <insonify/io/file.hpp>
#include <insonify/io/netpbm.hpp>
#include <insonify/raster/draw_options.hpp>
#include <insonify/seabed/any.hpp>
#include <insonify/seabed/flat.hpp>
#include <insonify/seabed/model.hpp>
#include <insonify/seabed/mud.hpp>
#include <insonify/seabed/none.hpp>
#include <insonify/seabed/registry.hpp>
#include <insonify/seabed/ripple_system.hpp>
#include <insonify/seabed/ripples.hpp>
#include <insonify/seabed/rock.hpp>
#include <insonify/seabed/roughness.hpp>
#include <insonify/seabed/sediment.hpp>
#include <insonify/seabed/trawl_marks.hpp>
#include <insonify/shadow/light.hpp>
#include <insonify/shadow/policy.hpp>
#include <insonify/sonar/backscatter.hpp>
#include <insonify/sonar/display.hpp>
#include <insonify/sonar/frame.hpp>
#include <insonify/sonar/labels.hpp>
#include <insonify/sonar/overhead/picture.hpp>
#include <insonify/sonar/overhead/rig.hpp>
#include <insonify/sonar/scene.hpp>
#include <insonify/sonar/sediment.hpp>
#include <insonify/sonar/side_scan/side_scan.hpp>
#include <insonify/version.hpp>

#if INSONIFY_BODIES
#include <insonify/sonar/overhead/render.hpp>
#endif

#include <insonify/compiled.hpp>
