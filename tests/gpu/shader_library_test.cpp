// Includes, defines, line directives and the translation of compiler logs: all text, no GL context.

#include "gpu/gl_loader.h"
#include "gpu/program.h"
#include "tests/gpu/shader_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace serosa::gpu {
namespace {

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST(ShaderLibraryText, EmbeddedSourcesEqualTheFiles) {
    const ShaderLibrary embedded;
    const ShaderLibrary onDisk{std::filesystem::path(SEROSA_SOURCE_DIR) / "shaders"};
    int count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(SEROSA_SOURCE_DIR) / "shaders")) {
        const std::string name = entry.path().filename().string();
        if (name == "CMakeLists.txt")
            continue;
        const auto fromBinary = embedded.text(name), fromDisk = onDisk.text(name);
        ASSERT_TRUE(fromBinary.ok()) << fromBinary.error().message;
        ASSERT_TRUE(fromDisk.ok()) << fromDisk.error().message;
        EXPECT_EQ(*fromBinary, *fromDisk) << name;
        ++count;
    }
    EXPECT_GE(count, 2);
}

TEST(ShaderLibraryText, DefinesFollowVersionAndLinesStayTrue) {
    const test::ShaderFolder folder;
    folder.write("a.frag", "// idea\n#version 450 core\nvoid main() {}\n");
    const auto shader = ShaderLibrary(folder.path()).expand("a.frag", {{"SIZE", "4"}, {"FLAG", ""}});
    ASSERT_TRUE(shader.ok()) << shader.error().message;
    EXPECT_EQ(shader->source,
              "// idea\n#version 450 core\n#define SIZE 4\n#define FLAG \n#line 3 0\nvoid main() {}\n");
}

TEST(ShaderLibraryText, EachIncludeIsGuardedAndNumberedOnce) {
    const test::ShaderFolder folder;
    folder.write("a.frag",
                 "#version 450 core\n#include \"b.glsl\"\n#include \"c.glsl\"\n#  include \"c.glsl\"\nend\n");
    folder.write("b.glsl", "#include \"c.glsl\"\nb\n");
    folder.write("c.glsl", "c\n");
    const auto shader = ShaderLibrary(folder.path()).expand("a.frag", {});
    ASSERT_TRUE(shader.ok()) << shader.error().message;
    const std::string c = "#ifndef SRS_INCLUDED_2\n#define SRS_INCLUDED_2\n#line 1 2\nc\n#endif\n";
    EXPECT_EQ(shader->source,
              "#version 450 core\n#line 2 0\n#ifndef SRS_INCLUDED_1\n#define SRS_INCLUDED_1\n#line 1 1\n" +
                  c + "#line 2 1\nb\n#endif\n#line 3 0\n" + c + "#line 4 0\n" + c + "#line 5 0\nend\n");
    ASSERT_EQ(shader->files.size(), 3u);
    EXPECT_EQ(shader->files[2].name, "c.glsl");
    EXPECT_EQ(shader->files[2].includedFrom, 1);
    EXPECT_EQ(shader->files[2].includedAtLine, 1);
}

TEST(ShaderLibraryText, ErrorsNameFileAndLineOfTheInclude) {
    const test::ShaderFolder folder;
    const ShaderLibrary library(folder.path());
    folder.write("missing.frag", "#version 450 core\n\n#include \"nowhere.glsl\"\n");
    EXPECT_TRUE(contains(library.expand("missing.frag", {}).error().message,
                         "missing.frag:3: no shader \"nowhere.glsl\""));
    folder.write("cycle.frag", "#version 450 core\n#include \"x.glsl\"\n");
    folder.write("x.glsl", "#include \"y.glsl\"\n");
    folder.write("y.glsl", "\n#include \"x.glsl\"\n");
    EXPECT_TRUE(
        contains(library.expand("cycle.frag", {}).error().message, "y.glsl:2: include cycle: \"x.glsl\""));
    folder.write("bare.frag", "void main() {}\n");
    EXPECT_TRUE(contains(library.expand("bare.frag", {}).error().message, "bare.frag: no #version line"));
    folder.write("early.frag", "#include \"x.glsl\"\n#version 450 core\n");
    EXPECT_TRUE(contains(library.expand("early.frag", {}).error().message,
                         "early.frag:1: an include before #version"));
    folder.write("form.frag", "#version 450 core\n#include <x.glsl>\n");
    EXPECT_TRUE(contains(library.expand("form.frag", {}).error().message, "form.frag:2: write #include"));
    EXPECT_FALSE(library.text("nowhere.glsl").ok());
    EXPECT_FALSE(library.text("").ok());
    EXPECT_FALSE(ShaderLibrary().text("nowhere.glsl").ok());
}

ExpandedShader twoFiles() {
    ExpandedShader shader;
    shader.files.push_back({"step.frag", "one\ntwo\nthree\nfour\nfive\nsix\n", -1, 0});
    shader.files.push_back({"spring.glsl", "alpha\nbeta\n", 0, 2});
    return shader;
}

TEST(ShaderLog, TranslatesTheFormsOfThreeDrivers) {
    for (const char* log : {"0:4(5): error: bad\n", "0(4) : error C1008: bad\n", "ERROR: 0:4: bad\n"}) {
        const std::string text = explainShaderLog(log, twoFiles());
        EXPECT_TRUE(contains(text, "step.frag:4: ")) << log << "->" << text;
        EXPECT_TRUE(contains(text, "bad\n")) << text;
        EXPECT_TRUE(contains(text, "     3 | three\n>    4 | four\n     5 | five\n")) << text;
        EXPECT_FALSE(contains(text, "| one")) << text;
    }
}

TEST(ShaderLog, NamesTheIncludeAndWhereItCameFrom) {
    const std::string text = explainShaderLog("1:2(1): error: bad\n", twoFiles());
    EXPECT_TRUE(contains(text, "spring.glsl:2: error: bad\n    included from step.frag:2\n")) << text;
    EXPECT_TRUE(contains(text, ">    2 | beta\n")) << text;
}

TEST(ShaderLog, KeepsLinesThatItDoesNotUnderstand) {
    EXPECT_EQ(explainShaderLog("7:2(1): error: no such file number\nsomething else\n", twoFiles()),
              "7:2(1): error: no such file number\nsomething else\n");
    EXPECT_EQ(explainShaderLog("", twoFiles()), "");
}

TEST(EntryPoints, NamesEveryMissingEntryPoint) {
    static const auto present = [] {};
    const auto functions = loadGl([](const char* name) -> GlProc {
        const std::string wanted = name;
        return wanted == "glClear" || wanted == "glViewport" ? nullptr : static_cast<GlProc>(present);
    });
    ASSERT_FALSE(functions.ok());
    EXPECT_EQ(functions.error().exitCode, 5);
    EXPECT_TRUE(contains(functions.error().message, "(glClear, glViewport)")) << functions.error().message;
}

} // namespace
} // namespace serosa::gpu
