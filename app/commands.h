#pragma once
// The short commands: each writes its text to `out` and returns an exit code, or an Error that the caller
// prints.

#include "base/result.h"

#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

namespace serosa::app {

/// `serosa inspect`: what a mesh is, and the lattice it would give. An open or otherwise unusable surface is
/// reported and then refused as an Error, with a hint where a repair would mend it. \param repair mend it
/// first, and say what was done. \param lengthUnit "mm", ...; empty: lengths are in file units.
/// \param spacing m (file units without a unit).
Result<int> inspectModel(const std::filesystem::path& file, bool repair, const std::string& lengthUnit,
                         std::size_t nodes, std::optional<double> spacing, std::ostream& out);

/// `serosa repair`: writes the mended surface, in the format that `to` names. An existing file is refused
/// without `force`. A file without a fault is written too, unchanged but for the format.
Result<int> repairModel(const std::filesystem::path& from, const std::filesystem::path& to, bool force,
                        std::ostream& out);

/// `serosa scene check`: everything that a run would check before it needs a GL context, but for memory.
Result<int> checkSceneFile(const std::filesystem::path& file, std::ostream& out);
/// `serosa scene explain`: every value with where it comes from, and what follows from them.
Result<int> explainSceneFile(const std::filesystem::path& file, std::ostream& out);
/// `serosa scene keys`: the reference of all keys.
Result<int> printSceneKeys(std::ostream& out);

/// `serosa scene deformation`: writes one of a scene's deformations as a texture file
/// (app/deformation_file.h), .nrrd or .mha. An existing file is refused without `force`. \param number of the
/// deformation, from 1
Result<int> writeSceneDeformation(const std::filesystem::path& scene, std::size_t number,
                                  const std::filesystem::path& file, bool force, std::ostream& out);

struct PhantomRequest {
    std::string name;
    std::size_t faces = 0; // of the surface; 0: the phantom's default
    std::filesystem::path file,
        volume;         // of the surface; of what cuts show (models/solid.h), .nrrd or .mha; empty: none
    double voxel = 1;   // mm, of the volume
    bool force = false; // replaces existing files, which are refused else
};
/// `serosa phantom`: writes a generated organ, in millimetres: nothing where one of the files cannot be.
Result<int> writePhantom(const PhantomRequest& request, std::ostream& out);

} // namespace serosa::app
