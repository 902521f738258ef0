// What is said about an organ's materials, and the colours that a picture shows them in.

#include "app/material_lines.h"

#include <gtest/gtest.h>

namespace serosa::app {
namespace {

/// Two cells of 10 mm beside each other along x, the second a fifth full and of material 1.
sim::Lattice twoCells() {
    return sim::latticeFromCells({{{0, 0, 0}, 255, 0}, {{1, 0, 0}, 51, 1}}, 0.01, glm::dvec3(0));
}

sim::Organ organ() {
    sim::Organ organ;
    organ.tissue.others.push_back({});
    organ.tissue.others.back().name = "bone";
    organ.tissue.others.back().young = 2e6;
    organ.tissue.others.back().density = 2000;
    return organ;
}

TEST(MaterialLines, GiveCellsVolumeAndMass) {
    const std::vector<MaterialLine> lines = materialLines(organ(), twoCells());
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0].name, "tissue");
    EXPECT_EQ(lines[0].text, "young 5 kPa, poisson 0.25, 1 cell, 1 ml, 1 g");
    EXPECT_EQ(lines[1].name, "bone");
    EXPECT_EQ(lines[1].text, "young 2000 kPa, poisson 0.25, 1 cell, 0.2 ml, 0.4 g");
    EXPECT_FALSE(plainTissue(organ()));
    EXPECT_TRUE(plainTissue({}));
    sim::Organ fibrous;
    fibrous.tissue.fibre = {1, 0, 0};
    fibrous.tissue.fibreYoung = 9000;
    fibrous.tissue.strainLimit = 0.2;
    EXPECT_FALSE(plainTissue(fibrous));
    EXPECT_NE(
        materialLines(fibrous, sim::latticeFromCells({{{0, 0, 0}, 255}}, 0.01, glm::dvec3(0)))[0].text.find(
            "; strain limit 0.2, 9 kPa along its fibres"),
        std::string::npos);
}

TEST(MaterialNotes, NameThinLayersOnceAndMaterialsWithoutCells) {
    sim::Organ withLayers = organ();
    withLayers.tissue.others.push_back(withLayers.tissue.others.front());
    withLayers.tissue.others.back().name = "fat";
    sim::MaterialRegion layer;
    layer.kind = sim::MaterialRegion::Kind::layer;
    layer.material = 1;
    layer.depth = 0.012; // not thin
    withLayers.regions = {layer};
    const std::vector<std::string> overwritten = materialNotes(withLayers, twoCells());
    ASSERT_EQ(overwritten.size(), 1u);
    EXPECT_EQ(overwritten[0], "no cell is left to fat: later regions took them all");
    layer.depth = 0.004;
    withLayers.regions = {layer, layer};
    const std::vector<std::string> notes = materialNotes(withLayers, twoCells());
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_EQ(notes[0].rfind("the layer of bone, 4 mm, is thinner than the lattice's spacing, 10 mm", 0), 0u)
        << notes[0];
    EXPECT_TRUE(materialNotes(organ(), twoCells()).empty());
}

// A vertex has the colour of the cell that it lies in; outside of all, of the nearest.
TEST(MaterialColours, AreThoseOfTheCells) {
    const sim::Lattice lattice = twoCells();
    const auto at = [&](double x, double y) { // in cells
        return lattice.toWorld(glm::dvec3(x, y, 0.5) - glm::dvec3(lattice.centre));
    };
    sim::TriangleMesh mesh;
    mesh.positions = {at(0.2, 0.5), at(0.99, 0.9), at(1.01, 0.1), at(1.9, 0.5), at(-0.1, 0.5), at(2.1, 1.2)};
    const std::vector<glm::u8vec3> colours = materialColours(lattice, mesh);
    ASSERT_EQ(colours.size(), 6u);
    EXPECT_NE(colours[0], colours[2]);
    EXPECT_EQ(colours[0], colours[1]);
    EXPECT_EQ(colours[2], colours[3]);
    EXPECT_EQ(colours[0], colours[4]);
    EXPECT_EQ(colours[2], colours[5]);
}

} // namespace
} // namespace serosa::app
