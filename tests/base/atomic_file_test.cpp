// A file appears complete or not at all: replaced on success, untouched and without leftovers on every
// failure.
#include "base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

namespace serosa {
namespace {

class AtomicFile : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (std::filesystem::temp_directory_path() / "serosa-atomic-XXXXXX").string();
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    static std::string content(const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    std::size_t entries() const {
        return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder_), {}));
    }

    std::filesystem::path folder_;
};

TEST_F(AtomicFile, WritesAndReplaces) {
    const auto file = folder_ / "a.txt";
    ASSERT_TRUE(writeFileAtomically(file, std::string_view("first, longer")).ok());
    EXPECT_EQ(content(file), "first, longer");
    ASSERT_TRUE(writeFileAtomically(file, std::string_view("a\0b", 3)).ok());
    EXPECT_EQ(content(file), std::string("a\0b", 3));
    EXPECT_EQ(entries(), 1u);
}

TEST_F(AtomicFile, TheNewFileIsReadableAsTheMaskSays) {
    const auto file = folder_ / "a.txt";
    const mode_t mask = ::umask(022);
    ASSERT_TRUE(writeFileAtomically(file, std::string_view("x")).ok());
    ::umask(mask);
    struct stat info {};
    ASSERT_EQ(::stat(file.c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0644u);
}

TEST_F(AtomicFile, ALinkStaysALink) {
    const auto file = folder_ / "a.txt", link = folder_ / "link.txt";
    ASSERT_TRUE(writeFileAtomically(file, std::string_view("old")).ok());
    std::filesystem::create_symlink("a.txt", link);
    ASSERT_TRUE(writeFileAtomically(link, std::string_view("new")).ok());
    EXPECT_TRUE(std::filesystem::is_symlink(link));
    EXPECT_EQ(content(file), "new");
}

TEST_F(AtomicFile, NamesWhatIsWrongWithThePath) {
    const auto refused = [&](const std::filesystem::path& file, const std::string& hint) {
        const Status status = writeFileAtomically(file, std::string_view("x"));
        ASSERT_FALSE(status.ok()) << file;
        EXPECT_EQ(status.error().exitCode, exitBadInput);
        EXPECT_NE(status.error().message.find(file.string()), std::string::npos) << status.error().message;
        EXPECT_NE(status.error().message.find(hint), std::string::npos) << status.error().message;
    };
    refused(folder_ / "missing" / "a.txt", "make the folder first");
    refused(folder_, "a folder");
    refused(folder_ / "", "file name is missing");
    std::ofstream(folder_ / "plain") << "x";
    refused(folder_ / "plain" / "a.txt", "not a folder");
    ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    refused(folder_ / "pipe", "not a regular file");
    EXPECT_EQ(entries(), 2u);
}

// A limit on the file size stands for a full disk: write() stores a part and then fails, as it does there.
TEST_F(AtomicFile, ADiskThatFillsUpLeavesTheOldFileAndNoTemporary) {
    const auto file = folder_ / "a.txt";
    ASSERT_TRUE(writeFileAtomically(file, std::string_view("old")).ok());
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{1000, before.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const Status status = writeFileAtomically(file, std::string(5000, 'x'));
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);

    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("cannot be written"), std::string::npos) << status.error().message;
    EXPECT_EQ(content(file), "old");
    EXPECT_EQ(entries(), 1u);
}

} // namespace
} // namespace serosa
