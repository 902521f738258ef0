// Children end in every way there is, and each is told from the others.

#include "base/child_process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>

namespace serosa {
namespace {

using namespace std::chrono_literals;

class ChildProcess : public testing::Test {
protected:
    Status shell(const std::string& script, double seconds = 60) const {
        return runChild({"sh", {"-c", script}, folder_.path(), seconds});
    }
    TemporaryFolder folder_ = TemporaryFolder::create().value();
};

TEST_F(ChildProcess, RunsInItsFolderWithNothingOnStdin) {
    ASSERT_TRUE(shell("cat > made; pwd -P").ok());
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "made"));
    std::ifstream output(folder_.path() / "output.txt");
    std::string line;
    std::getline(output, line);
    EXPECT_EQ(line, std::filesystem::canonical(folder_.path()).string());
}

TEST_F(ChildProcess, FailureHasTheLastWordsAndExitCode3) {
    const Status status = shell("echo first; echo 'self-intersection at facet 7' >&2; echo; exit 4");
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().exitCode, exitChildFailed);
    EXPECT_EQ(status.error().message,
              "the child 'sh' failed with exit code 4; it last said: self-intersection at facet 7");
}

TEST_F(ChildProcess, CrashIsNamed) {
    const Status status = shell("kill -SEGV $$");
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().exitCode, exitChildFailed);
    EXPECT_EQ(status.error().message, "the child 'sh' crashed: Segmentation fault");
}

TEST_F(ChildProcess, IsStoppedWithAllThatItStartedWhenTimeRunsOut) {
    const auto begin = std::chrono::steady_clock::now();
    const Status status = shell("sleep 100 & echo $! > inner; wait", 0.5);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().exitCode, exitChildFailed);
    EXPECT_EQ(status.error().message, "the child 'sh' took more than 0.5 s and was stopped");
    EXPECT_LT(took.count(), 50);
    std::ifstream file(folder_.path() / "inner");
    std::string inner;
    ASSERT_TRUE(file >> inner);
    // Gone, or dead and not yet reaped by whoever inherits it, as soon as the kernel gets to it.
    std::string id, name, state;
    do {
        std::ifstream stat("/proc/" + inner + "/stat");
        if (!(stat >> id >> name >> state))
            state = "gone";
    } while (state != "gone" && state != "Z" && std::chrono::steady_clock::now() - begin < 50s);
    EXPECT_TRUE(state == "gone" || state == "Z") << state;
}

TEST_F(ChildProcess, MissingProgramIsBadInput) {
    EXPECT_FALSE(programExists("no-such-program-of-serosa"));
    EXPECT_TRUE(programExists("sh"));
    const Status status = runChild({"no-such-program-of-serosa", {}, folder_.path(), 1});
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().exitCode, exitBadInput);
    EXPECT_NE(status.error().message.find("no-such-program-of-serosa"), std::string::npos);
}

TEST(TemporaryFolder, IsPrivateAndGoesAway) {
    std::filesystem::path path;
    {
        const TemporaryFolder folder = TemporaryFolder::create().value();
        path = folder.path();
        std::ofstream(path / "file") << "x";
        EXPECT_EQ(std::filesystem::status(path).permissions(), std::filesystem::perms::owner_all);
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

} // namespace
} // namespace serosa
