// The files that every image of a data set is drawn from: meshes, heightmap and references.
#pragma once

#include <insonify/filter/poisson.hpp>
#include <insonify/geometry/obj.hpp>
#include <insonify/insonify.hpp>
#include <insonify/seabed/blend.hpp>
#include <insonify/seabed/heightfield.hpp>
#include <insonify/sonar/speckle.hpp>

#include <map>
#include <optional>

#include "inputs.hpp"
#include "options.hpp"

namespace generator {

namespace in = insonify;

/// Meshes, heightmap and references, read once and shared by all images.
class shared_inputs {
  public:
    /// @throws io_error for a file that can't be read
    explicit shared_inputs(const options& o) {
        input_reader reader(o.input_limit);
        for (const std::string& mesh : o.meshes) {
            const std::size_t equals = mesh.find('=');
            const std::string name = mesh.substr(0, equals), path = mesh.substr(equals + 1);
            in::mesh shape = in::read_obj(reader.read("--mesh " + name, path), "--mesh " + name + " " + path);
            if (!has_area(shape)) throw in::io_error("--mesh " + name + " " + path + ": its polygons have no area");
            check_place(shape, "--mesh " + name + " " + path);
            meshes_[name] = upright(std::move(shape), o.mesh_up == "y");
        }
        if (!o.heightmap.empty()) {
            const in::image<float> picture = reader.read_picture("--heightmap", o.heightmap);
            if (picture.width() < 2 || picture.height() < 2)
                throw in::io_error("--heightmap " + o.heightmap + ": has fewer than 2 x 2 pixels");
            heightmap_ = in::seabed::from_image(picture, o.heightmap_spacing, static_cast<float>(o.heightmap_scale));
            check_heights(o);
        }
        for (const std::string& path : picture_paths(o.references)) {
            names_.push_back(utf8_name(path));
            references_.push_back(in::distribution_of(with_values(reader.read_picture("--reference", path), path)));
        }
        if (o.table) reader.add("--plan", o.table->name(), o.table->text());
        inputs_ = std::move(reader).list();
        drawn_references_ = references_.size();
        // A plan made from a demonstration names its synthetic reference.
        const bool demo_alone = references_.empty() && o.demo;
        if (demo_alone || (o.table && o.table->has("reference_name"))) {
            names_.push_back("made_up");
            references_.push_back(in::distribution_of(synthetic_reference()));
            if (demo_alone) drawn_references_ = 1;
        }
    }

    /// Number of references that images choose from at random.
    std::size_t references() const { return drawn_references_; }
    const in::distribution& reference(std::size_t i) const { return references_[i]; }
    const std::string& reference_name(std::size_t i) const { return names_[i]; }
    const in::seabed::heightfield& heightmap() const { return heightmap_; }
    const std::vector<input>& inputs() const { return inputs_; }

    /// A reference by its name; the number decides between files of the same name.
    std::optional<std::size_t> find_reference(const std::string& name, int number) const {
        const auto n = static_cast<std::size_t>(number);
        if (number >= 0 && n < names_.size() && names_[n] == name) return n;
        const auto found = std::find(names_.begin(), names_.end(), name);
        if (found == names_.end()) return std::nullopt;
        return static_cast<std::size_t>(found - names_.begin());
    }

    /// The mesh of a class, centred at the origin, its largest extent 1.
    const in::mesh& unit_mesh(const std::string& class_name) const { return meshes_.at(class_name); }
    glm::dvec3 extents_of_mesh(const std::string& class_name) const { return in::bounds(unit_mesh(class_name)).size(); }

  private:
    static bool has_area(const in::mesh& m) {
        for (const glm::uvec3& t : m.triangles) {
            const glm::dvec3 a(m.positions[t.x]), b(m.positions[t.y]), c(m.positions[t.z]);
            if (in::numeric::cross(b - a, c - a) != glm::dvec3(0)) return true;
        }
        return false;
    }

    /// @throws io_error where floats would move vertices by more than 0.001 of the mesh's size, as in map coordinates
    static void check_place(const in::mesh& m, const std::string& name) {
        const in::bounding_box box = in::bounds(m);
        const glm::dvec3 size = box.size();
        const double largest = (std::max)({size.x, size.y, size.z});
        double farthest = 0;
        for (int i = 0; i < 3; ++i) farthest = (std::max)({farthest, -box.lower[i], box.upper[i]});
        if (farthest > 1e4 * largest)
            throw in::io_error(name + ": is " + in::detail::to_text(largest) + " m in size and lies " +
                               in::detail::to_text(farthest) +
                               " m from the origin, where floats round its shape; move it to the origin");
    }

    /// Rotates z up, centres the mesh and scales its largest extent to 1.
    static in::mesh upright(in::mesh m, bool y_up) {
        if (y_up) m = in::transformed(std::move(m), in::to_world({.roll = in::literals::operator""_deg(90ull)}));
        const in::bounding_box box = in::bounds(m);
        const glm::dvec3 size = box.size();
        const double largest = (std::max)({size.x, size.y, size.z, 1e-9});
        return in::transformed(std::move(m), {glm::dmat3(1 / largest), -box.centre() / largest});
    }

    void check_heights(const options& o) const {
        bool any = false;
        for (const float h : heightmap_.heights.pixels()) {
            if (!in::numeric::is_finite(h)) continue;
            any = true;
            if (!(h >= -1e5f && h <= 1e5f))
                throw in::io_error("--heightmap " + o.heightmap + ": has a height of " + in::detail::to_text(h) +
                                   " m after --heightmap-scale " + in::detail::to_text(o.heightmap_scale) +
                                   ", expected -100000 to 100000; take a smaller scale");
        }
        if (!any) throw in::io_error("--heightmap " + o.heightmap + ": holds no finite height");
    }

    static in::image<float> with_values(in::image<float> picture, const std::string& path) {
        for (const float value : picture.pixels())
            if (in::numeric::is_finite(value)) return picture;
        throw in::io_error("--reference " + path + ": holds no finite value");
    }

    /// Gray values like those of a sonar: Rayleigh amplitudes, a quarter of full scale on average.
    static in::image<float> synthetic_reference() {
        return in::image<float>(256, 256, 0.25f) | in::rayleigh{.seed = 1};
    }

    std::map<std::string, in::mesh> meshes_;
    in::seabed::heightfield heightmap_;
    std::vector<in::distribution> references_;
    std::vector<std::string> names_;  ///< of the references
    std::size_t drawn_references_ = 0;
    std::vector<input> inputs_;
};

}  // namespace generator
