// The loop of `serosa view`: take what the user did, advance the frames that are due, draw, show.

#include "app/view.h"

#include "app/frame_clock.h"
#include "app/orbit_camera.h"
#include "app/progress.h"
#include "app/run_setup.h"
#include "app/scene_player.h"
#include "app/view_deformation.h"
#include "app/view_hand.h"
#include "app/view_panel.h"
#include "base/check.h"
#include "gpu/context_window.h"
#include "gpu/gl.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ostream>
#include <utility>

namespace serosa::app {

namespace {

constexpr int kExitInterrupted = 130;
constexpr int kMostFramesOwed = 8;          // beyond, the simulation runs slower than real time
constexpr double kMostSecondsAWhile = 0.03; // of steps between two pictures
constexpr double kIdleWait = 0.1;           // s: paused, between looks at the window
constexpr double kIdleRedraw = 0.5;         // s: paused, a picture at least so often
constexpr int kRedrawsAfterEvent = 3;       // the panel needs more than one to settle
constexpr double kSmoothing = 0.1;          // share of the newest time in a reading

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void smooth(double& reading, double ms) {
    reading = reading == 0 ? ms : reading + kSmoothing * (ms - reading);
}

class View {
public:
    View(RunParts& parts, gpu::Window& window, const ViewOptions& options, std::ostream& out)
        : parts_(parts), window_(window), options_(options), out_(out), player_(parts), panel_(window),
          clock_(1 / parts.scene.frameRate, kMostFramesOwed), size_(window.framebufferSize()),
          camera_(parts.scene.camera, parts.lowest(), parts.highest(), aspect()) {
        controls_.look = parts.scene.look;
        controls_.sceneMapping = parts.scene.look.mapping;
        controls_.panel = options.panel;
        readings_.scene = parts.scene.organs.front().name;
        for (const auto& organ : parts.organs) {
            readings_.nodes += organ->lattice.nodeCount();
            readings_.vertices += organ->surface.metres.positions.size();
            const std::string method = organ->solver ? methodName(organ->setup.method) : "";
            if (!method.empty())
                readings_.method = readings_.method.empty() || readings_.method == method ? method : "both";
        }
        const std::string& renderer = parts.context->info().renderer;
        readings_.renderer = renderer.substr(0, renderer.find_first_of("(/")); // less of its version
        readings_.software = parts.context->info().software;
        readings_.stepsPerFrame = player_.stepsPerFrame();
        if (!options.shaders.empty())
            reloadShaders();
    }

    Result<int> loop(const InterruptGuard& interrupt) {
        bool ended = false;
        while (!ended) {
            takeEvents(window_.poll(waitTime()));
            SEROSA_TRY(guideHand());
            guideDeformation();
            simulate();
            act();
            draw();
            if (const std::string problem = window_.problem(); !problem.empty())
                return Error{problem + " after frame " + std::to_string(player_.frame()) + " (state " +
                                 player_.stateHash() +
                                 "); screenshots written so far are whole; 'serosa run' needs no display",
                             exitNoGl};
            ended = controls_.quit || window_.closing() || interrupt.interrupted() || reachedEnd();
        }
        player_.check();
        out_ << "frame " << player_.frame() << ": t = " << player_.time() << " s, state "
             << player_.stateHash() << std::endl;
        if (const std::vector<std::string> stopped = player_.alarmLines(); !stopped.empty())
            return Error{"stopped by the watchdog: " + stopped.front(), exitCheckFailed};
        return interrupt.interrupted() ? kExitInterrupted : int(exitOk);
    }

private:
    double aspect() const { return double(std::max(1, size_.x)) / std::max(1, size_.y); }
    bool reachedEnd() const { return options_.quitAfter > 0 && player_.frame() >= options_.quitAfter; }

    void say(const std::string& text, bool isError = false) {
        readings_.message = text;
        readings_.isError = isError;
        redraws_ = kRedrawsAfterEvent;
        std::string line = text.substr(0, text.find('\n'));
        out_ << (isError ? "error: " : "") << line << std::endl;
    }

    double waitTime() const {
        if (controls_.paused || size_.x == 0)
            return redraws_ > 0 && size_.x > 0 ? 0 : kIdleWait;
        return options_.fast ? 0 : std::min(clock_.untilNext(), kIdleWait);
    }

    void takeEvents(const std::vector<gpu::WindowEvent>& events) {
        for (const gpu::WindowEvent& event : events) {
            redraws_ = kRedrawsAfterEvent;
            const bool isKey = event.kind == gpu::WindowEvent::Kind::keyPressed;
            input_.take(event, window_.size().y, isKey ? panel_.wantsKeyboard() : panel_.wantsMouse());
        }
    }

    Status guideHand() {
        if (!controls_.hand && hand_.idle())
            return {};
        SEROSA_ASSIGN(const std::string said,
                      hand_.follow(controls_, cameraView(), glm::dvec2(window_.size()), player_));
        if (!said.empty())
            say(said);
        return {};
    }

    void guideDeformation() {
        const ViewDeformation::Said said =
            deformation_.follow(controls_, cameraView(), glm::dvec2(window_.size()), player_.time());
        if (!said.text.empty())
            say(said.text, said.isError);
    }

    void frame() {
        const Clock::time_point start = Clock::now();
        hand_.beforeFrame((player_.frame() + 1) / parts_.scene.frameRate);
        player_.advance();
        hand_.afterFrame(player_);
        glFinish();
        smooth(readings_.stepsMs, 1e3 * secondsSince(start));
        if (const std::vector<std::string> stopped = player_.alarmLines(); stopped != readings_.stopped) {
            for (const std::string& line : stopped)
                if (std::find(readings_.stopped.begin(), readings_.stopped.end(), line) ==
                    readings_.stopped.end())
                    say("stopped by the watchdog: " + line, true);
            readings_.stopped = stopped;
        }
    }

    /// The frames that are due, as far as they can be taken before the next picture.
    void simulate() {
        const double elapsed = secondsSince(lastLook_);
        lastLook_ = Clock::now();
        if (controls_.restart) {
            hand_.restart();
            player_.reset();
            deformation_.restart();
            readings_.stopped = player_.alarmLines();
            clock_.restart();
            say("back at rest");
        }
        if (controls_.steps > 0) {
            controls_.paused = wasPaused_ = true;
            for (; controls_.steps > 0 && !reachedEnd(); --controls_.steps)
                frame();
            say("frame " + std::to_string(player_.frame()));
        }
        controls_.restart = false;
        controls_.steps = 0;
        if (std::exchange(wasPaused_, controls_.paused) != controls_.paused)
            say((controls_.paused ? "paused at frame " : "going on from frame ") +
                std::to_string(player_.frame()));
        if (controls_.paused) {
            clock_.restart();
            readings_.realTime = 0;
            paceStart_ = Clock::now();
            paceFrame_ = player_.frame();
            return;
        }
        const int due = options_.fast ? kMostFramesOwed : clock_.due(elapsed);
        for (int i = 0; i < due && !reachedEnd() && secondsSince(lastLook_) < kMostSecondsAWhile; ++i)
            frame();
        measurePace();
    }

    void measurePace() {
        constexpr double kWindow = 0.5; // s
        const double wall = secondsSince(paceStart_);
        if (player_.frame() < paceFrame_)
            paceFrame_ = player_.frame(); // a restart
        if (wall < kWindow)
            return;
        readings_.realTime = (player_.frame() - paceFrame_) / parts_.scene.frameRate / wall;
        paceStart_ = Clock::now();
        paceFrame_ = player_.frame();
    }

    render::CameraView cameraView() const {
        return render::makeCamera(camera_.settings(), parts_.lowest(), parts_.highest(), aspect());
    }

    render::View currentView() const {
        render::View view;
        view.camera = cameraView();
        view.light = parts_.scene.light;
        view.look = controls_.look;
        view.wireframe = controls_.wireframe;
        view.threads = drawnThreads(parts_, player_.threads(), player_.time());
        view.shapes = render::drawnShapes(parts_.scene, player_.time(), parts_.lowest(), parts_.highest());
        return view;
    }

    /// What was asked for and needs no picture.
    void act() {
        if (controls_.resetCamera)
            camera_.reset();
        if (controls_.reload)
            reloadShaders();
        controls_.resetCamera = controls_.reload = false;
    }

    void reloadShaders() {
        if (options_.shaders.empty())
            return say("start with --shaders DIR to take shaders from a folder", true);
        const Status reloaded =
            parts_.renderer->reload(gpu::ShaderLibrary(options_.shaders), parts_.textures(), currentView());
        if (reloaded.ok())
            say("shaders of " + options_.shaders.string());
        else
            say("shaders stay as they were: " + reloaded.error().message, true);
    }

    void draw() {
        const glm::ivec2 now = window_.framebufferSize();
        if (now != size_ && now.x > 0 && now.y > 0) {
            parts_.renderer->resize(now.x, now.y);
            redraws_ = kRedrawsAfterEvent;
        }
        size_ = now.x > 0 && now.y > 0 ? now : glm::ivec2(0);
        const bool wanted =
            !controls_.paused || redraws_ > 0 || secondsSince(lastDraw_) > kIdleRedraw || reachedEnd();
        if (size_.x == 0 || !wanted)
            return;
        redraws_ = std::max(0, redraws_ - 1);
        lastDraw_ = Clock::now();
        render::View view = currentView();
        const Status moved = parts_.implicit.moveTo(player_.time(), *parts_.renderer);
        const std::string wrong = moved.ok() ? "" : moved.error().message;
        if (!wrong.empty() && wrong != lastWrong_) // not in each picture again
            say(wrong, true);
        lastWrong_ = wrong;
        view.casters = parts_.implicit.casters(parts_.textures(), *parts_.renderer);
        parts_.renderer->draw(parts_.textures(), view);
        glFinish();
        smooth(readings_.drawMs, 1e3 * secondsSince(lastDraw_));
        if (controls_.picture)
            save(parts_.renderer->readImage(), "picture");
        parts_.renderer->show(size_.x, size_.y);
        readings_.frame = player_.frame();
        readings_.handForce = hand_.active() ? hand_.force() : -1;
        readings_.time = player_.time();
        readings_.stepMs = readings_.stepsPerFrame > 0 ? readings_.stepsMs / readings_.stepsPerFrame : 0;
        controls_.picture = false;
        const bool windowPicture = std::exchange(controls_.windowPicture, false);
        panel_.draw(controls_, readings_);
        if (windowPicture)
            save(readWindow(), "window");
        window_.present();
    }

    render::Image readWindow() const {
        const auto w = std::size_t(size_.x), h = std::size_t(size_.y);
        render::Image image{size_.x, size_.y, std::vector<std::uint8_t>(3 * w * h)};
        std::vector<std::uint8_t> rows(3 * w * h);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glReadPixels(0, 0, size_.x, size_.y, GL_RGB, GL_UNSIGNED_BYTE, rows.data());
        for (std::size_t y = 0; y < h; ++y) // GL's row 0 is the lowest
            std::copy_n(&rows[3 * w * (h - 1 - y)], 3 * w, &image.rgb[3 * w * y]);
        return image;
    }

    /// Never over a file that is there.
    void save(const render::Image& image, const std::string& kind) {
        std::filesystem::path file;
        for (int copy = 1; copy == 1 || std::filesystem::exists(file); ++copy) {
            char name[64];
            std::snprintf(name, sizeof name, copy == 1 ? "%s_%06d.png" : "%s_%06d_%d.png", kind.c_str(),
                          player_.frame(), copy);
            file = options_.pictures / name;
        }
        if (const Status written = render::writePng(image, file); written.ok())
            say("wrote " + file.string());
        else
            say(written.error().message, true);
    }

    RunParts& parts_;
    gpu::Window& window_;
    const ViewOptions& options_;
    std::ostream& out_;
    ScenePlayer player_;
    ViewPanel panel_;
    FrameClock clock_;
    glm::ivec2 size_; // pixels; (0, 0) while there is nothing to draw on
    OrbitCamera camera_;
    ViewControls controls_;
    ViewReadings readings_;
    ViewInput input_{controls_, camera_};
    ViewHand hand_{parts_};
    ViewDeformation deformation_{parts_};
    bool wasPaused_ = false;
    int redraws_ = kRedrawsAfterEvent;
    std::string lastWrong_; // of deformations
    Clock::time_point lastLook_ = Clock::now(), lastDraw_{}, paceStart_ = Clock::now();
    int paceFrame_ = 0;
};

} // namespace

Result<int> runView(const ViewOptions& options, std::ostream& out) {
    if (!options.shaders.empty() && !std::filesystem::is_directory(options.shaders))
        return Error{"--shaders: " + options.shaders.string() + " is no folder"};
    if (!std::filesystem::is_directory(options.pictures))
        return Error{"--out: " + options.pictures.string() + " is no folder: make it first"};
    std::unique_ptr<gpu::Window> window;
    RunParts parts; // dies first: its context's window is still there
    RunOptions run = options.run;
    run.hands = true;
    SEROSA_TRY(prepareRun(run, parts, [&](const sim::Scene& scene) -> Result<std::unique_ptr<gpu::Context>> {
        gpu::WindowRequest request;
        request.title = scene.organs.front().name + " - Serosa";
        request.width = scene.output.width;
        request.height = scene.output.height;
        SEROSA_ASSIGN(gpu::OpenedWindow opened, gpu::openWindow(request));
        window = std::move(opened.window);
        return std::move(opened.context);
    }));
    const glm::ivec2 size = window->framebufferSize();
    if (size.x > 0 && size.y > 0)
        parts.renderer->resize(size.x, size.y);
    const InterruptGuard interrupt;
    View view(parts, *window, options, out);
    for (const std::string& note : parts.toolNotes)
        out << "note: " << note << std::endl;
    for (const std::string& note : parts.implicit.notes())
        out << "note: " << note << std::endl;
    for (const std::string& note : contactNotes(parts.scene, parts.placedOrgans()))
        out << "note: " << note << std::endl;
    for (const std::string& note : couplingNotes(parts.scene, parts.placedOrgans()))
        out << "note: " << note << std::endl;
    out << "view: " << parts.scene.organs.front().name << ", " << parts.context->info().renderer << std::endl;
    for (std::size_t i = 0; i < parts.organs.size(); ++i)
        if (parts.scene.organs[i].method == sim::StepMethod::implicit)
            out << "step: " << parts.scene.organs[i].name << " takes implicit steps, "
                << implicitStepsText(parts.organs[i]->step) << std::endl;
    return view.loop(interrupt);
}

} // namespace serosa::app
