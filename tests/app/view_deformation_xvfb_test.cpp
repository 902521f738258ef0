// Deformations under the mouse in `serosa view` (app/view_deformation.h).
#include "tests/app/view_fixture.h"

namespace serosa::app {
namespace {

namespace fs = std::filesystem;

// A deformation of an organ at rest: moved by hand, by points, in the plane of the view; its box turned and
// scaled. What the view says of it, put into a scene, shows the same picture.
TEST_F(View, DeformationsFollowTheMouse) {
    const std::string body =
        "schema = 1\ngravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n"
        "[[organ]]\nname = \"ball\"\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\n"
        "[look]\nshow = \"implicit\"\nfield_samples = 40\n"
        "[output]\nsize = [480, 360]\nframe_every = 1000\n";
    const auto twist = [&](const std::string& place) {
        return body +
               "[[deformation]]\nkind = \"pull\"\nsize = [\"160 mm\", \"120 mm\", \"160 mm\"]\nradius = "
               "\"20 mm\"\n" +
               place + "\n";
    };
    folder_.write("pull.toml", twist("amount = \"25 mm\"\nat = [\"0 mm\", \"40 mm\", \"0 mm\"]"));
    ViewChild view(folder_.path(), {"pull.toml"}, server_->display());
    const auto window = server_->waitForWindow("ball - Serosa", kPatience);
    ASSERT_NE(window, 0U) << view.err();
    view.next("view: ball");
    server_->key("space");
    view.next("paused at frame ");
    std::vector<std::string> names;
    const auto picture = [&](const std::string& key = "s") {
        server_->key(key);
        names.push_back(view.next("wrote ./"));
        return image(names.back());
    };
    const auto drag = [&](unsigned button, int byX, int byY, int wheel) {
        server_->moveTo(400, 180); // beside the panel
        server_->hold("Control_L", true);
        server_->hold("Shift_L", true);
        server_->press(button);
        view.next(button == 1 ? "moves the pull" : "turns the pull");
        server_->moveTo(400 + byX, 180 + byY);
        for (int i = 0; i < wheel; ++i) {
            server_->press(4);
            server_->release(4);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        server_->release(button);
        server_->hold("Shift_L", false);
        server_->hold("Control_L", false);
        return view.next("pull: ");
    };
    const render::Image first = picture();
    const std::string moved = drag(1, 12, 0, 0);
    const render::Image second = picture();
    EXPECT_GT(apart(first, second), 100U);
    const std::string turned = drag(3, 0, 20, 2);
    const render::Image third = picture();
    picture("F12"); // with its box
    EXPECT_GT(apart(second, third), 100U);
    server_->key("r");
    view.next("back at rest");
    EXPECT_EQ(apart(picture(), first), 0U) << "as in the scene";
    // Nothing else can move here: there are no hands.
    server_->hold("Control_L", true);
    server_->press(1);
    view.next("no hands here: deformations alone");
    server_->release(1);
    server_->hold("Control_L", false);
    server_->key("q");
    EXPECT_EQ(view.wait(), 0) << view.err();
    EXPECT_EQ(view.err(), "");
    // What was said is a scene: one key a line.
    for (const auto& [said, seen] : {std::pair(moved, second), std::pair(turned, third)}) {
        std::string lines = said;
        for (const char* key : {", up =", ", along =", ", keys =", ", amount ="})
            if (const std::size_t at = lines.find(key); at != std::string::npos)
                lines.replace(at, 2, "\n");
        folder_.write("said.toml", twist(lines));
        const ChildResult ran =
            runSerosa(folder_.path(), {"run", "said.toml", "--frames", "1", "--out", "said", "--force"});
        ASSERT_EQ(ran.exitCode, 0) << ran.err << lines;
        EXPECT_LT(apart(image("said/frame_000001.png"), seen), 30U) << lines;
    }
    const fs::path kept = fs::path(SEROSA_BINARY_DIR) / "view-deformation";
    fs::remove_all(kept);
    fs::create_directories(kept);
    for (const std::string& name : names)
        fs::copy_file(path(name), kept / name, fs::copy_options::overwrite_existing);
}

// A control point goes where the pointer draws it.
TEST_F(View, ControlPointsFollowTheMouse) {
    folder_.write(
        "points.toml",
        "schema = 1\ngravity = [\"0 m/s2\", \"0 m/s2\", \"0 m/s2\"]\n"
        "[[organ]]\nname = \"ball\"\nmodel = \"ball.ply\"\nlength_unit = \"mm\"\nnodes = 200\n"
        "[look]\nshow = \"implicit\"\nfield_samples = 40\n"
        "[camera]\nprojection = \"orthographic\"\ndirection = [0, 0, -1]\nheight = \"240 mm\"\n"
        "target = [\"0 mm\", \"0 mm\", \"0 mm\"]\n"
        "[output]\nsize = [240, 240]\nframe_every = 1000\n"
        "[[deformation]]\nkind = \"points\"\nat = [\"0 mm\", \"0 mm\", \"0 mm\"]\nsize = [\"200 mm\", \"200 "
        "mm\", \"200 mm\"]\n"
        "texels = [32, 32, 32]\nreach = \"60 mm\"\n"
        "points = [{ from = [\"40 mm\", \"0 mm\", \"0 mm\"], to = [\"40 mm\", \"0 mm\", \"0 mm\"] },"
        " { from = [\"-40 mm\", \"0 mm\", \"0 mm\"], to = [\"-40 mm\", \"0 mm\", \"0 mm\"] }]\n");
    ViewChild view(folder_.path(), {"points.toml", "--no-panel"}, server_->display());
    const auto window = server_->waitForWindow("ball - Serosa", kPatience);
    ASSERT_NE(window, 0U) << view.err();
    view.next("view: ball");
    // A pixel is a millimetre: the first point, 10 mm up and 12 mm out.
    server_->moveTo(160, 120);
    server_->hold("Control_L", true);
    server_->hold("Shift_L", true);
    server_->press(1);
    view.next("point 1 of the points");
    server_->moveTo(172, 110);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    server_->release(1);
    server_->hold("Shift_L", false);
    server_->hold("Control_L", false);
    const std::string said = view.next("points: ");
    EXPECT_NE(said.find("to = [\"52 mm\", \"10 mm\", \"0 mm\"]"), std::string::npos) << said;
    EXPECT_NE(said.find("to = [\"-40 mm\", \"0 mm\", \"0 mm\"]"), std::string::npos) << said;
    server_->key("q");
    EXPECT_EQ(view.wait(), 0) << view.err();
    EXPECT_EQ(view.err(), "");
}

} // namespace
} // namespace serosa::app
