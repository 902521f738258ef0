// See app/version.h.

#include "app/version.h"

#include "app/vector_image.h"

#include <OpenMesh/Core/System/config.h>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <png.h>
#include <toml++/toml.h>

namespace serosa::app {

namespace {
template <class... Numbers>
std::string dotted(Numbers... numbers) {
    std::string text;
    ((text += (text.empty() ? "" : ".") + std::to_string(numbers)), ...);
    return text;
}
} // namespace

const char* programVersion() {
    return SEROSA_VERSION;
}

std::vector<std::pair<std::string, std::string>> partVersions() {
    return {
        {"compiler", "g++ " __VERSION__},
        {"glm", dotted(GLM_VERSION_MAJOR, GLM_VERSION_MINOR, GLM_VERSION_PATCH, GLM_VERSION_REVISION)},
        {"libpng", PNG_LIBPNG_VER_STRING},
        {"openmesh", dotted(OM_VERSION >> 16, (OM_VERSION >> 8) & 0xff)},
        {"tomlplusplus", dotted(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)},
        {"nlohmann_json",
         dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR, NLOHMANN_JSON_VERSION_PATCH)},
        {"itk", imageLibraryVersion()},
    };
}

} // namespace serosa::app
