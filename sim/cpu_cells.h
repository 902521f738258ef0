#pragma once
// Cells of the CPU solver, where Tissue::needsCellPass(): what the passes of sim/cpu_cells-inl.h read and
// write. Cells are at the slot of their lowest corner, so that a vector of cells finds its corners as a
// vector of nodes finds its neighbours.

#include "sim/cpu_arrays.h"
#include "sim/cpu_kernel.h"
#include "sim/cpu_layout.h"
#include "sim/tissue_field.h"

#include <cstdint>
#include <vector>

namespace serosa::sim {

class CpuCells {
public:
    /// With the lattice's own connections. Keeps references to the lattice, the layout and the field.
    CpuCells(const Lattice& lattice, const CpuLayout& layout, const TissueField& field, const Tissue& tissue);

    /// By what cuts left of the connections, 18 bits a node: a cell that lost one has no volumetric term.
    void connect(const std::vector<std::uint32_t>& connections);

    bool stiffens() const { return pass_.pairs > 0; }
    /// At the given positions (three arrays of slots).
    CpuCellPass pass(const VectorArray& positions) const;
    /// What the step takes of it.
    void enter(CpuStep& step) const;

private:
    void addVolumes();
    void addCurves(const Tissue& tissue);
    float* addArray();
    std::size_t slotOf(const LatticeCell& cell) const {
        return std::size_t(layout_.slotOfNode[std::size_t(lattice_.nodeAt(cell.grid))]);
    }

    const Lattice& lattice_;
    const CpuLayout& layout_;
    const TissueField& field_;
    std::vector<SlotArray<float>> arrays_; // all that pass_ points to
    SlotArray<std::uint32_t> bits_, material_;
    float *bulk_ = nullptr, *recovery_ = nullptr; // of arrays_
    std::vector<std::uint32_t> stiffening_;       // a block
    std::vector<CpuCurve> curves_;
    CpuCellPass pass_{};
};

} // namespace serosa::sim
