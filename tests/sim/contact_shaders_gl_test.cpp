// The shaders of contact against the CPU's functions, value by value: distances and normals of every shape,
// the contact of a point, the deepest point of a triangle and its contact.
#include "shaders/shared_constants.h"
#include "sim/contact_colliders.h"
#include "sim/contact_triangle.h"
#include "sim/distance_field.h"
#include "sim/shape_distance.h"
#include "tests/gl_fixture.h"
#include "tests/gpu/shader_folder.h"
#include "tests/sim/shapes.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <random>

using namespace serosa;

namespace {

const char* const kProbe = R"(#version 450 core
layout(local_size_x = 64) in;
#include "contact_triangle.glsl"
layout(std430) readonly buffer b_inputs { vec4 b_input[]; };   // 9 a probe: own points, two triangles, depths
layout(std430) writeonly buffer b_outputs { vec4 b_output[]; }; // 5 a probe
uniform int u_probes;
void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= u_probes)
        return;
    int c = int(b_input[9 * i].w);
    dvec3 y0 = dvec3(b_input[9 * i].xyz), y1 = dvec3(b_input[9 * i + 1].xyz);
    dvec3 depths = dvec3(b_input[9 * i + 8].xyz);
    Corners from = Corners(dvec3(b_input[9 * i + 2].xyz), dvec3(b_input[9 * i + 3].xyz), dvec3(b_input[9 * i + 4].xyz));
    Corners to = Corners(dvec3(b_input[9 * i + 5].xyz), dvec3(b_input[9 * i + 6].xyz), dvec3(b_input[9 * i + 7].xyz));
    b_output[5 * i] = vec4(sampleShape(c, y0));
    b_output[5 * i + 1] = vec4(vec3(pointContact(c, y0, y1, depths.x, sweepSamples(distance(y0, y1), thinOf(c)))), 0.0);
    b_output[5 * i + 2] = vec4(deepestPoint(c, to, depths));
    dvec3 weights;
    b_output[5 * i + 3] = vec4(vec3(triangleContact(c, from, to, depths, weights)), 0.0);
    b_output[5 * i + 4] = vec4(vec3(weights), 0.0);
}
)";

/// The program's own shaders, with the probe beside them.
void fillFolder(const test::ShaderFolder& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(SEROSA_SOURCE_DIR "/shaders"))
        if (entry.path().extension() == ".glsl" || entry.path().extension() == ".h")
            std::filesystem::copy_file(entry.path(), folder.path() / entry.path().filename());
    folder.write("probe.comp", kProbe);
}

struct Probe {
    int collider = 0;
    glm::vec3 y0, y1;
    glm::vec3 from[3], to[3];
    glm::vec3 depths;
};
struct Answer {
    glm::vec4 sample, point, deepest, triangle, weights;
};

class GlContactShaders : public test::GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        setup.lattice = &lattice;
        setup.timeStep = 1e-3;
        sim::Body body;
        body.friction = 0.3;
        sim::RigidShape& shape = body.shape;
        const double h = lattice.spacing;
        const auto add = [&](sim::ShapeKind kind, double radius) {
            shape.kind = kind;
            shape.radius = radius * h;
            setup.bodies.push_back(body);
        };
        add(sim::ShapeKind::sphere, 2);
        shape.length = 4 * h;
        add(sim::ShapeKind::capsule, 0.7);
        shape.middle = glm::dvec3(0.3, -0.2, 0.5) * h;
        shape.halfSize = glm::dvec3(1.5, 0.6, 2.5) * h;
        add(sim::ShapeKind::box, 0.2);
        shape.bend = 1.5 * h;
        add(sim::ShapeKind::hook, 0.6);
        add(sim::ShapeKind::halfSpace, 0);
        shape.field = std::make_shared<sim::DistanceField>(test::ballMesh(2 * h, 3), 32);
        add(sim::ShapeKind::mesh, 0);
        for (const sim::ToolMotion& motion : sim::colliderMotions(setup, 0))
            motions.push_back(motion);
    }

    std::vector<Answer> ask(const std::vector<Probe>& probes) {
        std::vector<glm::vec4> inputs;
        for (const Probe& probe : probes) {
            inputs.emplace_back(probe.y0, probe.collider);
            inputs.emplace_back(probe.y1, 0);
            for (const glm::vec3& p : probe.from)
                inputs.emplace_back(p, 0);
            for (const glm::vec3& p : probe.to)
                inputs.emplace_back(p, 0);
            inputs.emplace_back(probe.depths, 0);
        }
        sim::ContactColliders colliders(setup);
        colliders.prepare(0, 1);
        const test::ShaderFolder folder;
        fillFolder(folder);
        auto made =
            gpu::Program::create(gpu::ShaderLibrary(folder.path()), {"probe.comp"}, colliders.defines());
        EXPECT_TRUE(made.ok()) << made.error().message;
        gpu::Program program = std::move(made).value();
        const gpu::Buffer input("inputs", std::span<const glm::vec4>(inputs)),
            output("outputs", probes.size() * sizeof(Answer), nullptr);
        program.set("u_probes", int(probes.size()));
        program.buffer("b_inputs", input).buffer("b_outputs", output);
        colliders.bind(program, 0, sim::ContactColliders::Precision::exact, true);
        program.dispatch({int(probes.size()), 1, 1});
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        std::vector<Answer> answers(probes.size());
        output.download(0, answers.size() * sizeof(Answer), answers.data());
        return answers;
    }

    sim::Lattice lattice = test::blockLattice(1, 1, 1);
    sim::SolverSetup setup;
    std::vector<sim::ToolMotion> motions;
};

glm::vec3 randomVector(std::mt19937& random, float size) {
    const auto one = [&] { return size * (float(random() >> 8) / 8388608.0f - 1); };
    const float x = one(), y = one(), z = one();
    return {x, y, z};
}

} // namespace

TEST_F(GlContactShaders, giveTheCpusDistancesNormalsAndContacts) {
    std::mt19937 random(11);
    std::vector<Probe> probes;
    for (int i = 0; i < 12000; ++i) {
        Probe probe;
        probe.collider = i % 6;
        probe.y0 = randomVector(random, 4);
        probe.y1 = probe.y0 + randomVector(random, i % 5 ? 0.2f : 3.0f);
        // A triangle of the size of a cell's, that moves and bends a little.
        const glm::vec3 at = randomVector(random, 2.5f), way = randomVector(random, i % 5 ? 0.1f : 2.0f);
        for (int k = 0; k < 3; ++k) {
            probe.from[k] = at + randomVector(random, 0.8f);
            probe.to[k] = probe.from[k] + way + randomVector(random, 0.02f);
            probe.depths[k] = i % 3 ? 0.0f : randomVector(random, 0.3f).x;
        }
        probes.push_back(probe);
    }
    const std::vector<Answer> answers = ask(probes);
    std::array<int, 6> touches{}, apart{};
    int other = 0; // where rounding chose another start or step
    for (std::size_t i = 0; i < probes.size(); ++i) {
        const Probe& probe = probes[i];
        const Answer& answer = answers[i];
        const sim::RigidShape& shape = motions[std::size_t(probe.collider)].shape;
        SCOPED_TRACE(std::to_string(i) + " of shape " + std::to_string(probe.collider));
        const sim::ShapeSample sample = sim::sampleShape(shape, probe.y0);
        EXPECT_NEAR(answer.sample.w, sample.distance, 1e-6);
        EXPECT_LT(glm::distance(glm::dvec3(answer.sample), sample.normal), 1e-6);
        const sim::ContactShape collider{shape, sim::thinnestHalfWidth(shape), 0.3};
        const glm::dvec3 point = sim::pointContact(
            collider, probe.y0, probe.y1, probe.depths.x,
            sim::sweepSamples(glm::distance(glm::dvec3(probe.y0), glm::dvec3(probe.y1)), collider.thin));
        const sim::Corners from{probe.from[0], probe.from[1], probe.from[2]},
            to{probe.to[0], probe.to[1], probe.to[2]};
        const sim::TriangleGap deepest = sim::deepestPoint(shape, to, probe.depths);
        other += std::abs(answer.deepest.w - deepest.gap) > 1e-6;
        const sim::TriangleContact contact = sim::triangleContact(collider, from, to, probe.depths);
        const double worst = std::max(glm::distance(glm::dvec3(answer.point), point),
                                      glm::distance(glm::dvec3(answer.triangle), contact.move));
        touches[std::size_t(probe.collider)] += point != glm::dvec3(0) || contact.move != glm::dvec3(0);
        apart[std::size_t(probe.collider)] += worst > 1e-5;
    }
    EXPECT_LE(other, 12) << "of 12,000";
    for (std::size_t kind = 0; kind < 6; ++kind) {
        EXPECT_GT(touches[kind], 100) << kind;
        EXPECT_LE(apart[kind], touches[kind] / 100) << kind;
    }
}
