// See app/state_files.h.
#include "app/state_files.h"

#include "app/vector_image.h"
#include "base/atomic_file.h"
#include "sim/displacement.h"

#include <cstdio>

namespace serosa::app {

namespace {
std::string sixDigits(int frame) {
    char digits[16];
    std::snprintf(digits, sizeof digits, "%06d", frame);
    return digits;
}
} // namespace

StateFiles::StateFiles(const RunParts& parts, ScenePlayer& player, OutputFolder& folder)
    : parts_(parts), player_(player), folder_(folder) {}

Status StateFiles::write() {
    const int frame = player_.frame();
    if (displacementFrames_.contains(frame))
        for (std::size_t i = 0; i < parts_.organs.size(); ++i)
            SEROSA_TRY(writeDisplacement(i));
    if (!snapshotFrames_.contains(frame))
        return {};
    ++snapshots_;
    return sim::writeSnapshot(player_.snapshot(), folder_.file("snapshot_" + sixDigits(frame) + ".serosa"));
}

std::string StateFiles::fileName(std::size_t organ, const std::string& what,
                                 const std::string& extension) const {
    const std::string name =
        parts_.organs.size() > 1 ? sim::organFileName(parts_.scene.organs[organ]) + "_" : "";
    return "displacement_" + name + what + extension;
}

Status StateFiles::writeDisplacement(std::size_t organ) {
    const sim::Lattice& lattice = parts_.organs[organ]->lattice;
    const sim::LatticeState state = player_.state(organ);
    const sim::DisplacementGrid grid = sim::displacementGrid(lattice, state);
    const std::string extension =
        parts_.scene.output.displacementFormat == sim::ImageFormat::nrrd ? ".nrrd" : ".mha";
    const std::string frame = sixDigits(player_.frame());
    SEROSA_TRY(writeDisplacementImage(grid, folder_.file(fileName(organ, frame, extension))));
    if (masked_.insert(organ).second) // the same at all times
        SEROSA_TRY(writeNodeMask(grid, folder_.file(fileName(organ, "mask", extension))));
    SEROSA_TRY(writeFileAtomically(folder_.file(fileName(organ, frame, ".ply")),
                                   std::string_view(sim::displacementPly(lattice, state))));
    ++displacements_;
    return {};
}

} // namespace serosa::app
