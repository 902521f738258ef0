// See app/view_input.h.

#include "app/view_input.h"

#include <algorithm>
#include <cmath>

namespace serosa::app {

namespace {

constexpr double kKeyStep = 0.03; // of the window's height
constexpr double kKeyZoom = 1.1, kWheelZoom = 1.12;

} // namespace

void ViewInput::take(const gpu::WindowEvent& event, int height, bool taken) {
    if (event.kind != gpu::WindowEvent::Kind::keyPressed)
        mouse(event, std::max(1, height), taken);
    else if (!taken)
        key(event);
}

void ViewInput::mouse(const gpu::WindowEvent& event, double height, bool taken) {
    using Kind = gpu::WindowEvent::Kind;
    if (event.kind == Kind::scrolled) { // amounts, no place
        if (controls_.hand || controls_.box)
            controls_.deeper += event.at.y;
        else if (!taken)
            camera_.zoom(std::pow(kWheelZoom, event.at.y));
        return;
    }
    const glm::dvec2 moved = glm::dvec2(event.at.x - pointer_.x, pointer_.y - event.at.y) / height;
    pointer_ = controls_.pointer = event.at;
    if (event.kind == Kind::buttonPressed && !taken && event.control && event.shift) {
        controls_.box = event.button == gpu::MouseButton::left ? BoxDrag::move : BoxDrag::turn;
        return;
    }
    if (event.kind == Kind::buttonPressed && !taken && event.control) {
        controls_.hand = event.button == gpu::MouseButton::left ? HandKind::grasp : HandKind::probe;
        return;
    }
    if (event.kind == Kind::buttonPressed && !taken)
        drag_ = event.button == gpu::MouseButton::left && !event.shift ? Drag::turn : Drag::move;
    if (event.kind == Kind::buttonReleased) {
        drag_ = Drag::none;
        controls_.hand.reset();
        controls_.box.reset();
    }
    if (event.kind != Kind::moved)
        return;
    if (drag_ == Drag::turn)
        camera_.orbit(moved);
    else if (drag_ == Drag::move)
        camera_.pan(moved);
}

void ViewInput::key(const gpu::WindowEvent& event) {
    const auto turnOrMove = [&](const glm::dvec2& by) {
        if (event.shift)
            camera_.pan(by);
        else
            camera_.orbit(by);
    };
    switch (event.key) { // those that repeat while they are held
    case gpu::keyLeft:
        return turnOrMove({-kKeyStep, 0});
    case gpu::keyRight:
        return turnOrMove({kKeyStep, 0});
    case gpu::keyUp:
        return turnOrMove({0, kKeyStep});
    case gpu::keyDown:
        return turnOrMove({0, -kKeyStep});
    case gpu::keyPageUp:
    case '+':
    case '=':
        return camera_.zoom(kKeyZoom);
    case gpu::keyPageDown:
    case '-':
        return camera_.zoom(1 / kKeyZoom);
    case '.':
        ++controls_.steps;
        return;
    default:
        if (!event.repeated)
            press(event.key);
    }
}

void ViewInput::press(int key) {
    switch (key) {
    case ' ':
        controls_.paused = !controls_.paused;
        break;
    case 'r':
        controls_.restart = true;
        break;
    case '1':
    case '2':
    case '3':
        controls_.look.mapping = sim::Mapping(key - '1');
        break;
    case '4':
        controls_.look.mapping = controls_.sceneMapping;
        break;
    case 'l':
        controls_.look.lattice = !controls_.look.lattice;
        break;
    case 'w':
        controls_.wireframe = !controls_.wireframe;
        break;
    case 'n':
        controls_.look.colour = controls_.look.colour == sim::SurfaceColour::tissue
                                    ? sim::SurfaceColour::dynamicNormal
                                    : sim::SurfaceColour::tissue;
        break;
    case 'd':
        controls_.nextBox = true;
        break;
    case 'c':
    case gpu::keyHome:
        controls_.resetCamera = true;
        break;
    case 's':
        controls_.picture = true;
        break;
    case gpu::keyF12:
        controls_.windowPicture = true;
        break;
    case gpu::keyF5:
        controls_.reload = true;
        break;
    case 'p':
        controls_.panel = !controls_.panel;
        break;
    case 'q':
    case gpu::keyEscape:
        controls_.quit = true;
        break;
    default:
        break;
    }
}

} // namespace serosa::app
