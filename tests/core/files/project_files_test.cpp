#include "core/files/project_files.h"
#include "core/files/write_file.h"

#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace meshwind {
namespace {

namespace fs = std::filesystem;

class ProjectFiles : public testing::Test {
protected:
    ProjectFiles() {
        fs::create_directories(home_ / "data" / "meshes");
        fs::create_directories(home_ / "machines");
        ::setenv("MESHWIND_HOME", home_.c_str(), 1);
    }
    ~ProjectFiles() override {
        ::unsetenv("MESHWIND_HOME");
        fs::remove_all(home_);
    }

    const fs::path home_ = fs::path(testing::TempDir()) /
                           ("project_files." + std::to_string(::getpid()) + "." +
                            testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(ProjectFiles, HomeIsWhatTheEnvironmentSays) {
    EXPECT_EQ(project_home(), home_);
}

TEST_F(ProjectFiles, BareNamesAreLookedUp) {
    write_file(home_ / "data" / "meshes" / "a part.stl", "");
    write_file(home_ / "machines" / "a machine.json", "");
    EXPECT_EQ(find_input("a part.stl"), home_ / "data" / "meshes" / "a part.stl");
    EXPECT_EQ(find_input("a machine.json"), home_ / "machines" / "a machine.json");
    EXPECT_EQ(find_input("a machine"), home_ / "machines" / "a machine.json");
}

TEST_F(ProjectFiles, OtherNamesStayAsTheyAre) {
    EXPECT_EQ(find_input("missing.stl"), "missing.stl");
    EXPECT_EQ(find_input("./part.stl"), "./part.stl");
    EXPECT_EQ(find_input(""), "");
    const std::string existing = (home_ / "machines").string();
    EXPECT_EQ(find_input(existing), existing);
}

}  // namespace
}  // namespace meshwind
