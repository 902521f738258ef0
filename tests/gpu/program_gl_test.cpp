// Programs: numbered errors that name the include, typed setters, and the refusal to draw with an unset
// input.

#include "gpu/handles.h"
#include "gpu/program.h"
#include "tests/gl_fixture.h"
#include "tests/gpu/shader_folder.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace serosa::gpu {
namespace {

constexpr int kSide = 4;

class GlProgram : public test::GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        folder.write("pass.vert", ShaderLibrary().text("pass.vert").value());
    }
    /// pass.vert with a fragment shader of that text (without its #version).
    Result<Program> create(const std::string& fragment, const std::vector<ShaderDefine>& defines = {}) const {
        folder.write("a.frag", "#version 450 core\n" + fragment);
        return Program::create(ShaderLibrary(folder.path()), {"pass.vert", "a.frag"}, defines);
    }
    /// Draws over an RGBA32F image and returns its first texel.
    static glm::vec4 draw(Program& program) {
        const Texture2D target("target", GL_RGBA32F, kSide, kSide);
        Framebuffer framebuffer("target");
        framebuffer.attach(GL_COLOR_ATTACHMENT0, target);
        framebuffer.bind(kSide, kSide);
        const VertexArray empty("empty");
        program.use();
        drawFullScreen(empty);
        std::array<glm::vec4, kSide * kSide> texels{};
        target.download(texels.data(), sizeof texels);
        for (const glm::vec4& texel : texels)
            EXPECT_EQ(texel, texels[0]) << "the triangle must cover every pixel";
        return texels[0];
    }
    test::ShaderFolder folder;
};

TEST_F(GlProgram, EverySetterReachesItsUniform) {
    auto program = create(R"(
struct Tool { vec3 at; float radius; };
uniform float u_f; uniform int u_i; uniform uint u_u; uniform bool u_b; uniform vec2 u_v2; uniform vec3 u_v3;
uniform vec4 u_v4; uniform ivec2 u_i2; uniform ivec3 u_i3; uniform mat3 u_m3; uniform mat4 u_m4;
uniform vec4 u_array[3]; uniform float u_floats[2]; uniform int u_ints[2]; uniform Tool u_tools[2];
out vec4 o_value;
void main() {
    o_value = vec4(u_f + float(u_i) + float(u_u) + (u_b ? 1000.0 : 0.0),
                   u_v2.y + u_v3.z + u_v4.w + float(u_i2.y) + float(u_i3.z),
                   (u_m3 * vec3(1, 0, 0)).y + (u_m4 * vec4(0, 0, 0, 1)).x,
                   u_array[0].x + u_array[2].w + u_floats[1] + float(u_ints[1]) + u_tools[1].radius + u_tools[0].at.x);
})");
    ASSERT_TRUE(program.ok()) << program.error().message;
    glm::mat3 m3(0.0f);
    m3[0][1] = 5.0f; // column 0, row 1
    glm::mat4 m4(0.0f);
    m4[3][0] = 70.0f;
    const std::vector<glm::vec4> array = {{1, 0, 0, 0}, {9, 9, 9, 9}, {0, 0, 0, 20}};
    const std::vector<float> floats = {9, 300};
    const std::vector<int> ints = {9, 4000};
    program->set("u_f", 0.5f).set("u_i", -2).set("u_u", 40u).set("u_b", 1);
    program->set("u_v2", glm::vec2(9, 1))
        .set("u_v3", glm::vec3(9, 9, 20))
        .set("u_v4", glm::vec4(9, 9, 9, 300));
    program->set("u_i2", glm::ivec2(9, 4000))
        .set("u_i3", glm::ivec3(9, 9, 50000))
        .set("u_m3", m3)
        .set("u_m4", m4);
    program->set("u_array", array).set("u_floats", floats).set("u_ints", ints);
    program->set("u_tools[0].radius", 9.0f).set("u_tools[1].at", glm::vec3(9)); // active as a whole
    program->set("u_tools[1].radius", 50000.0f).set("u_tools[0].at", glm::vec3(600000, 0, 0));
    EXPECT_EQ(draw(*program), glm::vec4(1038.5f, 54321.0f, 75.0f, 654321.0f));
}

TEST_F(GlProgram, SamplersAndImagesBind) {
    auto program = create(R"(
uniform sampler2D t_state; uniform usampler2D t_info;
layout(rgba32ui) uniform readonly uimage2D i_read; layout(rgba32f) uniform writeonly image2D i_write;
out vec4 o_value;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    imageStore(i_write, at, vec4(7.0));
    o_value = vec4(texelFetch(t_state, at, 0).y, texelFetch(t_info, at, 0).w, imageLoad(i_read, at).x, 1.0);
})");
    ASSERT_TRUE(program.ok()) << program.error().message;
    Texture2D state("state", GL_RGBA32F, kSide, kSide), info("info", GL_RGBA32UI, kSide, kSide),
        read("read", GL_RGBA32UI, kSide, kSide), written("written", GL_RGBA32F, kSide, kSide);
    state.clear(glm::vec4(1, 2, 3, 4));
    info.clear(glm::uvec4(5, 6, 7, 8));
    read.clear(glm::uvec4(9, 10, 11, 12));
    program->texture("t_state", state).texture("t_info", info);
    program->image("i_read", read, GL_READ_ONLY).image("i_write", written, GL_WRITE_ONLY);
    EXPECT_EQ(draw(*program), glm::vec4(2, 8, 9, 1));
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    std::array<glm::vec4, kSide * kSide> texels{};
    written.download(texels.data(), sizeof texels);
    EXPECT_EQ(texels[5], glm::vec4(7.0f));
}

const char* const kTwoInputs = "uniform vec4 u_value; uniform sampler2D t_state; out vec4 o_value;\n"
                               "void main() { o_value = u_value + texelFetch(t_state, ivec2(0), 0); }\n";

TEST_F(GlProgram, RefusesToDrawWithAnUnsetInputByName) {
    auto program = create(kTwoInputs);
    ASSERT_TRUE(program.ok()) << program.error().message;
    EXPECT_EQ(program->unsetInputs(), (std::vector<std::string>{"t_state", "u_value"}));
    program->set("u_value", glm::vec4(0));
    EXPECT_EQ(program->unsetInputs(), std::vector<std::string>{"t_state"});
    EXPECT_DEATH(program->use(), "pass.vert \\+ a.frag: input \"t_state\" was never set");
    Texture2D texture("state", GL_RGBA32F, 1, 1);
    program->texture("t_state", texture);
    EXPECT_TRUE(program->unsetInputs().empty());
    program->use();
    texture = Texture2D();
    EXPECT_DEATH(program->use(), "the texture of input \"t_state\" is gone");
    EXPECT_DEATH(Program().use(), "empty program");
}

TEST_F(GlProgram, UnknownNamesAndOtherTypesAreBrokenPromises) {
    auto program =
        create("uniform vec4 u_value; uniform float u_unused; uniform vec4 u_four[4]; out vec4 o_value;\n"
               "void main() { o_value = u_value + u_four[3]; }\n");
    ASSERT_TRUE(program.ok()) << program.error().message;
    program->set("u_unused", 1.0f); // removed by the compiler: ignored
    EXPECT_EQ(program->unsetInputs(), (std::vector<std::string>{"u_four", "u_value"}));
    EXPECT_DEATH(program->set("u_valu", 1.0f), "has no input \"u_valu\"");
    EXPECT_DEATH(program->set("u_value", 1.0f), "\"u_value\" is of another type");
    const std::vector<glm::vec4> three(3);
    EXPECT_DEATH(program->set("u_four", three), "has 4 elements, 3 were given");
}

TEST_F(GlProgram, MismatchesOfAnEditedSourceAreKeptForAMessage) {
    auto program = create(
        "uniform vec4 u_value; uniform vec4 u_four[4]; uniform float u_other; uniform sampler2D t_never;\n"
        "out vec4 o_value;\nvoid main() { o_value = u_value + u_four[3] + u_other + "
        "texelFetch(t_never, ivec2(0), 0); }\n");
    ASSERT_TRUE(program.ok()) << program.error().message;
    program->tolerateMismatches();
    program->set("u_valu", 1.0f).set("u_value", 1.0f);
    const std::vector<glm::vec4> three(3);
    program->set("u_four", three);
    draw(*program); // does not abort
    const std::string name = "pass.vert + a.frag";
    EXPECT_EQ(program->takeMismatches(),
              (std::vector<std::string>{name + " has no input \"u_valu\"",
                                        name + ": input \"t_never\" was never set",
                                        name + ": input \"u_four\" has 4 elements, 3 were given",
                                        name + ": input \"u_other\" was never set",
                                        name + ": input \"u_value\" is of another type in the shader"}));
    EXPECT_TRUE(program->takeMismatches().empty()) << "taken once";
}

TEST_F(GlProgram, ArraysOfSamplersAreAnErrorOfTheSource) {
    const auto program =
        create("uniform sampler2D t_two[2]; out vec4 o_value;\n"
               "void main() { o_value = texelFetch(t_two[0], ivec2(0), 0) + texelFetch(t_two[1], "
               "ivec2(0), 0); }\n");
    ASSERT_FALSE(program.ok());
    EXPECT_NE(program.error().message.find("t_two: arrays of samplers"), std::string::npos)
        << program.error().message;
}

TEST_F(GlProgram, CompileErrorsNameTheIncludeWithNumberedSource) {
    folder.write("spring.glsl", "// springs\nfloat force(float x) {\n    return x * stiffnes;\n}\n");
    const auto program =
        create("#include \"spring.glsl\"\nout vec4 o_value;\nvoid main() { o_value = vec4(force(1.0)); }\n");
    ASSERT_FALSE(program.ok());
    const std::string& message = program.error().message;
    EXPECT_NE(message.find("a.frag does not compile"), std::string::npos) << message;
    EXPECT_NE(message.find("spring.glsl:3: "), std::string::npos) << message;
    EXPECT_NE(message.find("included from a.frag:2"), std::string::npos) << message;
    EXPECT_NE(message.find(">    3 |     return x * stiffnes;"), std::string::npos) << message;
}

TEST_F(GlProgram, ErrorsAfterDefinesAndIncludesKeepTheirLine) {
    folder.write("empty.glsl", "// one\n// two\n// three\n");
    const auto program =
        create("#include \"empty.glsl\"\nout vec4 o_value;\nvoid main() { o_value = oops; }\n",
               {{"A", "1"}, {"B", "2"}});
    ASSERT_FALSE(program.ok());
    EXPECT_NE(program.error().message.find("a.frag:4: "), std::string::npos) << program.error().message;
}

TEST_F(GlProgram, AnIncludeInAnInactiveBranchDoesNotHideTheNext) {
    folder.write("value.glsl", "float value() { return 3.0; }\n");
    folder.write("twice.glsl", "#include \"value.glsl\"\n#include \"value.glsl\"\n");
    auto program =
        create("#ifdef NEVER\n#include \"value.glsl\"\n#endif\n#include \"twice.glsl\"\nout vec4 o_value;\n"
               "void main() { o_value = vec4(value()); }\n");
    ASSERT_TRUE(program.ok()) << program.error().message;
    EXPECT_EQ(draw(*program), glm::vec4(3.0f));
}

TEST_F(GlProgram, DefinesReachTheSource) {
    auto program = create("out vec4 o_value;\nvoid main() { o_value = vec4(VALUE); }\n", {{"VALUE", "2.5"}});
    ASSERT_TRUE(program.ok()) << program.error().message;
    EXPECT_EQ(draw(*program), glm::vec4(2.5f));
}

TEST_F(GlProgram, LinkErrorsNameTheStages) {
    const auto program =
        create("in vec4 v_missing; out vec4 o_value;\nvoid main() { o_value = v_missing; }\n");
    ASSERT_FALSE(program.ok());
    EXPECT_NE(program.error().message.find("pass.vert + a.frag does not link"), std::string::npos);
    EXPECT_NE(program.error().message.find("v_missing"), std::string::npos) << program.error().message;
    folder.write("a.shader", "#version 450 core\nvoid main() {}\n");
    EXPECT_FALSE(Program::create(ShaderLibrary(folder.path()), {"a.shader"}).ok());
}

TEST_F(GlProgram, StorageBlocksBindAndWholeGroupsCoverTheItems) {
    folder.write("sum.comp",
                 "#version 450 core\nlayout(local_size_x = 8, local_size_y = 2) in;\n"
                 "layout(std430) readonly buffer b_in { uint b_value[]; };\n"
                 "layout(std430) buffer b_out { uint b_result[]; };\n"
                 "uniform ivec3 u_items;\n"
                 "void main() {\n"
                 "    if (any(greaterThanEqual(ivec3(gl_GlobalInvocationID), u_items))) return;\n"
                 "    uint at = gl_GlobalInvocationID.y * uint(u_items.x) + gl_GlobalInvocationID.x;\n"
                 "    b_result[at] += 2u * b_value[at];\n}\n");
    auto program = Program::create(ShaderLibrary(folder.path()), {"sum.comp"});
    ASSERT_TRUE(program.ok()) << program.error().message;
    EXPECT_EQ(program->groupSize(), glm::ivec3(8, 2, 1));
    EXPECT_EQ(program->unsetInputs(), (std::vector<std::string>{"b_in", "b_out", "u_items"}));
    const glm::ivec3 items(13, 3, 1); // no multiple of the group
    std::vector<unsigned> values(39), results(39, 1);
    for (unsigned i = 0; i < values.size(); ++i)
        values[i] = i;
    const Buffer in("in", std::span<const unsigned>(values)), out("out", std::span<const unsigned>(results));
    program->set("u_items", items).buffer("b_in", in);
    EXPECT_DEATH(program->dispatch(items), "input \"b_out\" was never set");
    program->buffer("b_out", out);
    program->dispatch(items);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    out.download(0, out.bytes(), results.data());
    for (unsigned i = 0; i < results.size(); ++i)
        EXPECT_EQ(results[i], 1 + 2 * i);
    EXPECT_DEATH(program->dispatch({0, 1, 1}), "a dispatch of nothing");
    EXPECT_DEATH(program->buffer("b_other", in), "has no input \"b_other\"");
    {
        const Buffer gone("gone", 4, nullptr);
        program->buffer("b_in", gone);
    }
    EXPECT_DEATH(program->use(), "the buffer of input \"b_in\" is gone");
    EXPECT_DEATH(program->buffer("b_in", Buffer()), "was given an empty buffer");
    auto drawn = create("out vec4 o_value;\nvoid main() { o_value = vec4(1.0); }\n");
    ASSERT_TRUE(drawn.ok());
    EXPECT_EQ(drawn->groupSize(), glm::ivec3(0));
    EXPECT_DEATH(drawn->dispatch(items), "has no compute stage");
}

TEST_F(GlProgram, ComputeAndTransformFeedbackRun) {
    folder.write(
        "a.comp",
        "#version 450 core\nlayout(local_size_x = 4, local_size_y = 4) in;\n"
        "layout(rgba32ui) uniform writeonly uimage2D i_out;\n"
        "void main() { imageStore(i_out, ivec2(gl_GlobalInvocationID.xy), gl_GlobalInvocationID.xyzz); }\n");
    auto compute = Program::create(ShaderLibrary(folder.path()), {"a.comp"});
    ASSERT_TRUE(compute.ok()) << compute.error().message;
    Texture2D out("out", GL_RGBA32UI, kSide, kSide);
    compute->image("i_out", out, GL_WRITE_ONLY).use();
    glDispatchCompute(1, 1, 1);
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    std::array<glm::uvec4, kSide * kSide> texels{};
    out.download(texels.data(), sizeof texels);
    EXPECT_EQ(texels[6], glm::uvec4(2, 1, 0, 0));

    folder.write("f.vert",
                 "#version 450 core\nout vec2 v_a;\nout float v_b;\n"
                 "void main() { v_a = vec2(gl_VertexID, 10); v_b = -1.0; gl_Position = vec4(0); }\n");
    auto feedback = Program::create(ShaderLibrary(folder.path()), {"f.vert"}, {}, {"v_a", "v_b"});
    ASSERT_TRUE(feedback.ok()) << feedback.error().message;
    // Without a window there is no default framebuffer, and even a draw that rasterizes nothing wants one.
    Framebuffer framebuffer("out");
    framebuffer.attach(GL_COLOR_ATTACHMENT0, out);
    framebuffer.bind(kSide, kSide);
    const Buffer captured("captured", 2 * 3 * sizeof(float), nullptr);
    const VertexArray empty("empty");
    feedback->use();
    glBindVertexArray(empty.id());
    glEnable(GL_RASTERIZER_DISCARD);
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, captured.id());
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, 2);
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    std::array<float, 6> values{};
    captured.download(0, sizeof values, values.data());
    EXPECT_EQ(values, (std::array<float, 6>{0, 10, -1, 1, 10, -1}));
}

} // namespace
} // namespace serosa::gpu
