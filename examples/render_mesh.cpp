// An imported mesh on a rocky seabed: render_mesh [mesh] [out.png] [y|z: which axis is up]
//
// Reads OBJ by itself, and whatever assimp reads (FBX, glTF, STL, PLY, ...) where it was built with assimp.
#include <insonify/core/thread_pool.hpp>
#include <insonify/geometry/obj.hpp>
#include <insonify/insonify.hpp>
#include <insonify/io/png.hpp>

#if defined(EXAMPLES_ASSIMP)
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#endif

#include <cstdio>

#include "common/usage.hpp"

namespace in = insonify;
using namespace in::literals;

namespace {

/// All triangles of a file, in its own frame.
in::mesh load(const std::string& path) {
#if defined(EXAMPLES_ASSIMP)
    if (!path.ends_with(".obj")) {
        Assimp::Importer importer;
        const aiScene* const file =
            importer.ReadFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_GenNormals);
        if (file == nullptr) throw in::io_error(path + ": " + importer.GetErrorString());
        in::mesh all;
        for (unsigned part = 0; part < file->mNumMeshes; ++part) {
            const aiMesh& m = *file->mMeshes[part];
            if (!m.HasNormals()) continue;  // points or lines
            const auto first = static_cast<std::uint32_t>(all.positions.size());
            for (unsigned i = 0; i < m.mNumVertices; ++i) {
                all.positions.emplace_back(m.mVertices[i].x, m.mVertices[i].y, m.mVertices[i].z);
                all.normals.emplace_back(m.mNormals[i].x, m.mNormals[i].y, m.mNormals[i].z);
            }
            for (unsigned i = 0; i < m.mNumFaces; ++i)
                if (const aiFace& f = m.mFaces[i]; f.mNumIndices == 3)
                    all.triangles.push_back(first + glm::uvec3(f.mIndices[0], f.mIndices[1], f.mIndices[2]));
        }
        return all;
    }
#endif
    return in::load_obj(path);
}

}  // namespace

int main(int argc, char** argv) try {
    examples::check_arguments(argc, argv, 0, 3, "render_mesh [mesh [out.png [y or z: which axis is up]]]");
    const std::string path = argc > 1 ? argv[1] : EXAMPLES_MESH;
    const std::string up = argc > 3 ? argv[3] : "y";
    if (up != "y" && up != "z") throw in::invalid_input("the axis that is up is '" + up + "', expected y or z");

    in::mesh shape = load(path);
    if (up == "y") shape = in::transformed(std::move(shape), in::to_world({.roll = 90_deg}));
    const glm::dvec3 size = in::bounds(shape).size();
    const double largest = (std::max)({size.x, size.y, size.z});
    if (!(largest > 0)) throw in::invalid_input(path + ": has no triangles with an extent");

    in::scene scene;
    scene.seabed = in::seabed::rock{.relief = 0.15f, .seed = 4};
    // As if it were 1.5 m long, whatever the file's unit.
    const in::pose pose{.position = {-1.5, 0, 0}, .yaw = 35_deg, .scale = static_cast<float>(1.5 / largest)};
    scene.add(shape, in::rest_on(scene.seabed, shape, pose), "mesh");

    in::thread_pool pool;
    const auto frame = in::render(scene, {.altitude = 4, .size = {1024, 1024}, .grazing = 8_deg}, {}, pool);
    in::write_png(argc > 2 ? argv[2] : "mesh.png", frame.image | in::speckle{.variance = 0.03f} | in::colormap::copper);
} catch (const std::exception& error) {
    std::fprintf(stderr, "render_mesh: %s\n", error.what());
    return 1;
}
