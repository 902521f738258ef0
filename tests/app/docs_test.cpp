// What the documents say about the tree: links and their #anchors lead somewhere, files that they name are
// there, pictures are shown, scenes are read by the program.
#include "sim/scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace serosa::app {
namespace {

namespace fs = std::filesystem;

const fs::path kSource = SEROSA_SOURCE_DIR;

std::string readWhole(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// README.md and its neighbours, and all of docs/.
std::vector<fs::path> documents() {
    std::vector<fs::path> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(kSource))
        if (entry.path().extension() == ".md")
            found.push_back(entry.path());
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSource / "docs"))
        if (entry.path().extension() == ".md")
            found.push_back(entry.path());
    std::sort(found.begin(), found.end());
    return found;
}

std::string nameOf(const fs::path& file) {
    return file.lexically_relative(kSource).string();
}

struct Document {
    std::string prose;               // without fenced code
    std::vector<std::string> scenes; // fenced TOML that begins a scene file
};

Document split(const std::string& text) {
    Document document;
    std::istringstream lines(text);
    std::string fence, block;
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind("```", 0) != 0) {
            (fence.empty() ? document.prose : block) += line + "\n";
        } else if (fence.empty()) {
            fence = line;
        } else {
            if (fence == "```toml" && block.rfind("schema = 1\n", 0) == 0)
                document.scenes.push_back(block);
            fence.clear();
            block.clear();
        }
    }
    EXPECT_TRUE(fence.empty()) << "a fence is not closed";
    return document;
}

std::vector<std::string> allMatches(const std::string& text, const std::regex& pattern) {
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), pattern), end; match != end; ++match)
        found.push_back((*match)[1]);
    return found;
}

/// What stands in `code` spans.
std::vector<std::string> codeSpans(const std::string& prose) {
    return allMatches(prose, std::regex("`([^`\n]+)`"));
}

/// Targets of [text](target) and ![text](target) outside of code spans.
std::vector<std::string> linksOf(const std::string& prose) {
    const std::string plain = std::regex_replace(prose, std::regex("`[^`\n]*`"), "code");
    return allMatches(plain, std::regex("\\]\\(([^)\\s]+)\\)"));
}

/// Anchors of headings as GitHub makes them: lower case, blanks to hyphens, other signs gone, repeats
/// numbered.
std::set<std::string> anchorsOf(const std::string& prose) {
    std::set<std::string> anchors;
    std::map<std::string, int> seen;
    for (const std::string& heading : allMatches("\n" + prose, std::regex("\n#+ +([^\n]+)"))) {
        std::string anchor;
        for (const char c : heading)
            if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
                anchor += char(std::tolower(static_cast<unsigned char>(c)));
            else if (c == ' ')
                anchor += '-';
        const int repeats = seen[anchor]++;
        anchors.insert(repeats == 0 ? anchor : anchor + "-" + std::to_string(repeats));
    }
    return anchors;
}

/// Why a link of `from` leads nowhere; empty if it leads somewhere.
std::string brokenLink(const fs::path& from, const std::string& target) {
    if (target.rfind("https://", 0) == 0)
        return ""; // not asked over the network
    const std::size_t hash = target.find('#');
    const std::string path = target.substr(0, hash);
    const fs::path to = path.empty() ? from : (from.parent_path() / path).lexically_normal();
    if (!fs::exists(to))
        return "there is no " + nameOf(to);
    if (hash == std::string::npos)
        return "";
    if (anchorsOf(split(readWhole(to)).prose).count(target.substr(hash + 1)) == 0)
        return nameOf(to) + " has no heading for it";
    return "";
}

TEST(Documents, LinksLeadSomewhere) {
    std::size_t links = 0;
    for (const fs::path& file : documents())
        for (const std::string& target : linksOf(split(readWhole(file)).prose)) {
            ++links;
            EXPECT_EQ(brokenLink(file, target), "") << nameOf(file) << ": (" << target << ")";
        }
    EXPECT_GT(links, 100u);
}

TEST(Documents, BrokenLinksWouldBeFound) {
    const fs::path readme = kSource / "README.md";
    EXPECT_EQ(linksOf("a [b](c.md#d) and `[e](f)` and ![g](h.png)"),
              (std::vector<std::string>{"c.md#d", "h.png"}));
    EXPECT_EQ(anchorsOf("# What it does (yet)\n## `run`, and a_b\n## `run`, and a_b\n"),
              (std::set<std::string>{"what-it-does-yet", "run-and-a_b", "run-and-a_b-1"}));
    EXPECT_NE(brokenLink(readme, "docs/no-such-page.md"), "");
    EXPECT_NE(brokenLink(readme, "docs/cli.md#no-such-heading"), "");
    EXPECT_NE(brokenLink(readme, "#no-such-heading"), "");
    EXPECT_EQ(brokenLink(readme, "docs/cli.md#exit-codes"), "");
}

TEST(Documents, NamedFilesExist) {
    const std::regex ours(
        "(app|base|bench|cmake|docs|gpu|models|render|scripts|shaders|sim|tests)/[A-Za-z0-9_./-]*");
    std::size_t named = 0;
    for (const fs::path& file : documents())
        for (const std::string& code : codeSpans(split(readWhole(file)).prose)) {
            if (!std::regex_match(code, ours) || code.rfind("models/generated", 0) == 0)
                continue;
            ++named;
            EXPECT_TRUE(fs::exists(kSource / code)) << nameOf(file) << " names " << code;
        }
    EXPECT_GT(named, 50u);
}

TEST(Documents, EveryPictureIsShown) {
    std::set<fs::path> shown;
    for (const fs::path& file : documents())
        for (const std::string& target : linksOf(split(readWhole(file)).prose))
            shown.insert((file.parent_path() / target).lexically_normal());
    for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "docs" / "images"))
        EXPECT_EQ(shown.count(entry.path().lexically_normal()), 1u) << nameOf(entry.path());
}

/// Scenes are read in a folder of their own, beside empty files in place of their models.
class Scenes : public ::testing::Test {
protected:
    Scenes() : folder_(fs::path(::testing::TempDir()) / "serosa-docs-test") {
        fs::remove_all(folder_);
        fs::create_directories(folder_ / "scenes");
    }
    ~Scenes() override { fs::remove_all(folder_); }

    void expectRead(const std::string& text, const std::string& from) {
        for (const std::string& model : allMatches(text, std::regex("\n(?:model|file) = \"([^\"]+)\""))) {
            const fs::path file = (folder_ / "scenes" / model).lexically_normal();
            fs::create_directories(file.parent_path());
            std::ofstream{file};
        }
        const fs::path file = folder_ / "scenes" / "scene.toml";
        std::ofstream(file) << text;
        const Result<sim::Scene> scene = sim::readScene(file);
        EXPECT_TRUE(scene) << from << ": " << (scene ? "" : scene.error().message) << "\n" << text;
    }

    fs::path folder_;
};

TEST_F(Scenes, OfTheDocumentsAreRead) {
    std::size_t scenes = 0;
    for (const fs::path& file : documents())
        for (const std::string& text : split(readWhole(file)).scenes) {
            ++scenes;
            expectRead(text, nameOf(file));
        }
    EXPECT_GE(scenes, 5u);
}

TEST_F(Scenes, OfTheModelsAreReadAndNamed) {
    std::vector<std::regex> named; // `heart.toml`, `models/scenes/figure*.toml`
    for (const fs::path& file : documents())
        for (std::string code : codeSpans(split(readWhole(file)).prose)) {
            if (const std::size_t slash = code.rfind('/'); slash != std::string::npos)
                code.erase(0, slash + 1);
            if (std::regex_match(code, std::regex("[A-Za-z0-9_*]+\\.toml")))
                named.emplace_back(std::regex_replace(std::regex_replace(code, std::regex("\\."), "\\."),
                                                      std::regex("\\*"), ".*"));
        }
    std::size_t scenes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(kSource / "models" / "scenes")) {
        ++scenes;
        expectRead(readWhole(entry.path()), nameOf(entry.path()));
        const std::string name = entry.path().filename().string();
        EXPECT_TRUE(std::any_of(named.begin(), named.end(),
                                [&](const std::regex& one) { return std::regex_match(name, one); }))
            << "no document names models/scenes/" << name << ": say there what it shows";
    }
    EXPECT_GE(scenes, 10u);
}

} // namespace
} // namespace serosa::app
