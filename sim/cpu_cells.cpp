// See sim/cpu_cells.h.
#include "sim/cpu_cells.h"

#include "sim/pieces.h"

namespace serosa::sim {

namespace {

CpuCurve curveOf(const MaterialShares& material) {
    CpuCurve curve{};
    for (std::size_t pair = 0; pair < material.spring.size(); ++pair)
        curve.spring[pair] = float(material.spring[pair]);
    curve.bulk = float(material.bulk);
    curve.twoOverYoung = float(2 / material.young);
    curve.bend = float(material.bend);
    for (const CurveBreak& turn : material.breaks) {
        curve.strain[curve.turns] = float(turn.strain);
        curve.gain[curve.turns] = float(turn.gain);
        ++curve.turns;
    }
    return curve;
}

} // namespace

CpuCells::CpuCells(const Lattice& lattice, const CpuLayout& layout, const TissueField& field,
                   const Tissue& tissue)
    : lattice_(lattice), layout_(layout), field_(field), bits_(layout.slots()), material_(layout.slots()) {
    pass_.rows = layout.rows.front().data();
    pass_.first = layout.first;
    pass_.bits = bits_.get();
    if (tissue.volumetric())
        addVolumes();
    if (tissue.stiffens())
        addCurves(tissue);
    connect(lattice.connections);
}

float* CpuCells::addArray() {
    return arrays_.emplace_back(layout_.slots()).get();
}

void CpuCells::addVolumes() {
    pass_.bulk = bulk_ = addArray();
    pass_.recovery = recovery_ = addArray();
    for (float*& force : pass_.rowForces)
        force = addArray();
}

void CpuCells::addCurves(const Tissue& tissue) {
    pass_.pairs = tissue.fibrous() ? 9 : 1;
    for (float*& stretch : pass_.stretches)
        stretch = addArray();
    for (int pair = 0; pair < pass_.pairs; ++pair) {
        float* constants = addArray();
        for (std::size_t cell = 0; cell < lattice_.cells.size(); ++cell)
            constants[slotOf(lattice_.cells[cell])] = float(
                lattice_.cells[cell].fill / (4 * 255.0) * field_.materialOf(cell).spring[std::size_t(pair)]);
        pass_.constants[pair] = constants;
        pass_.stiffened[pair] = addArray();
    }
    for (const MaterialShares& material : field_.materials())
        curves_.push_back(curveOf(material));
    pass_.curves = curves_.data();
    stiffening_.assign(layout_.blocks(), 0);
    for (const LatticeCell& cell : lattice_.cells) {
        const std::size_t slot = slotOf(cell);
        material_[slot] = cell.material;
        if (curves_[cell.material].turns > 0)
            stiffening_[(slot - layout_.first) / layout_.lanes] |= 1u << cell.material;
    }
    pass_.material = material_.get();
    pass_.stiffening = stiffening_.data();
}

void CpuCells::connect(const std::vector<std::uint32_t>& connections) {
    for (std::size_t node = 0; node < connections.size(); ++node) {
        const auto rowBit = [&](const glm::ivec3& offset, std::uint32_t bit) {
            return lattice_.nodeAt(lattice_.nodes[node] + offset) >= 0 ? bit : 0u;
        };
        bits_[std::size_t(layout_.slotOfNode[node])] = connections[node] | rowBit({0, -1, -1}, kRowBelowYZ) |
                                                       rowBit({0, 0, -1}, kRowBelowZ) |
                                                       rowBit({0, -1, 0}, kRowBelowY);
    }
    if (!pass_.bulk)
        return;
    const std::vector<bool> whole = wholeCells(lattice_, connections);
    for (std::size_t i = 0; i < lattice_.cells.size(); ++i) {
        const LatticeCell& cell = lattice_.cells[i];
        const double fill = whole[i] ? cell.fill / 255.0 : 0;
        bulk_[slotOf(cell)] = float(fill * field_.materialOf(i).bulk);
        recovery_[slotOf(cell)] = float(fill * field_.materialOf(i).recovery);
    }
}

CpuCellPass CpuCells::pass(const VectorArray& positions) const {
    CpuCellPass pass = pass_;
    for (int axis = 0; axis < 3; ++axis)
        pass.positions[axis] = positions.axis[axis].get();
    return pass;
}

void CpuCells::enter(CpuStep& step) const {
    step.bits = pass_.bits;
    std::copy(std::begin(pass_.rowForces), std::end(pass_.rowForces), std::begin(step.rowForces));
    std::copy(std::begin(pass_.stiffened), std::end(pass_.stiffened), std::begin(step.stiffened));
}

} // namespace serosa::sim
