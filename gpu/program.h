#pragma once
// Shader programs: sources from the embedded library (or a folder on disk), includes, defines, numbered
// errors that name the include, typed setters, and refusal to draw while an active uniform, sampler or image
// was never set.

#include "base/result.h"
#include "gpu/handles.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace serosa::gpu {

class Texture3D; // gpu/sampled_texture.h
class TiledTexture;

struct ShaderDefine {
    std::string name, value;
};

/// A stage's whole source. Files are numbered by #line in the order in which they were first included; 0 is
/// the stage.
struct ExpandedShader {
    struct File {
        std::string name;
        std::string text;
        int includedFrom = -1; // index of the file, -1 for the stage itself
        int includedAtLine = 0;
    };
    std::string source;
    std::vector<File> files;
};

/// Where shader text comes from: the binary, or a folder (hot reload). `#include "name"` at the start of a
/// line is resolved here; a file that is included several times counts once, at the first place that is
/// active.
class ShaderLibrary {
public:
    ShaderLibrary() = default;                            // embedded sources
    explicit ShaderLibrary(std::filesystem::path folder); // files on disk, for editing
    /// Whole source of a stage after includes and defines (which follow #version), with #line directives.
    /// Errors: unknown file or include (with file and line of the include), include cycles, a stage without
    /// #version.
    Result<ExpandedShader> expand(const std::string& name, const std::vector<ShaderDefine>& defines) const;
    /// The text of one file without expansion.
    Result<std::string> text(const std::string& name) const;

private:
    std::optional<std::filesystem::path> folder_;
};

/// A compiler's log with the file names instead of source numbers, each error followed by the numbered lines
/// around it and by the includes that led there. Understands the forms of Mesa, NVIDIA and AMD.
std::string explainShaderLog(const std::string& log, const ExpandedShader& shader);

/// A linked program. Setters keep values in the program object (DSA); unknown names are SEROSA_CHECKs unless
/// the compiler removed them (a name that the source never mentions is a broken promise; an inactive one is
/// ignored).
class Program : public Handle {
public:
    Program() = default;
    Program(Program&&) noexcept = default;
    Program& operator=(Program&& other) noexcept;
    ~Program();

    /// \param stages file names; the suffix (.vert .geom .frag .comp) says the stage.
    /// Errors: compile and link logs with file:line of the shader file or include, and the numbered source
    /// around it.
    /// \param feedback outputs of the last vertex stage that transform feedback captures, interleaved in this
    /// order
    static Result<Program> create(const ShaderLibrary& library, const std::vector<std::string>& stages,
                                  const std::vector<ShaderDefine>& defines = {},
                                  const std::vector<std::string>& feedback = {});

    /// The type must be the shader's (int and unsigned also set a bool).
    Program& set(const std::string& name, float value);
    Program& set(const std::string& name, int value);
    Program& set(const std::string& name, unsigned value);
    Program& set(const std::string& name, const glm::vec2& value);
    Program& set(const std::string& name, const glm::vec3& value);
    Program& set(const std::string& name, const glm::vec4& value);
    Program& set(const std::string& name, const glm::ivec2& value);
    Program& set(const std::string& name, const glm::ivec3& value);
    Program& set(const std::string& name, const glm::mat3& value);
    Program& set(const std::string& name, const glm::mat4& value);
    /// Arrays: name without [0]; every element that the shader uses.
    Program& set(const std::string& name, std::span<const float> values);
    Program& set(const std::string& name, std::span<const int> values);
    Program& set(const std::string& name, std::span<const glm::vec4> values);
    /// Sampler `t_...`: remembers the texture (which must outlive the draw); bound to a unit by use().
    Program& texture(const std::string& name, const Texture2D& texture);
    Program& texture(const std::string& name, const Texture3D& texture);
    Program& texture(const std::string& name, const TiledTexture& texture);
    /// Image `i_...` (image2D, uimage2D): remembers texture and access; bound by use(). access: GL_READ_ONLY,
    /// ...
    Program& image(const std::string& name, const Texture2D& texture, GLenum access);
    /// The same of a volume (uimage3D, layout(r32ui)).
    Program& image(const std::string& name, const Texture3D& texture, GLenum access);
    /// Storage block `b_...`: remembers the buffer (which must outlive the draw or dispatch); bound by use().
    Program& buffer(const std::string& name, const Buffer& buffer);
    /// Uniform block `b_...`: remembers `bytes` of the buffer from `offset` on, a multiple of
    /// uniformOffsetStep(); bound by use().
    Program& uniforms(const std::string& name, const Buffer& buffer, std::size_t offset, std::size_t bytes);

    /// glUseProgram and binds samplers, images and storage blocks. SEROSA_CHECKs, naming the input, that
    /// every active one was set.
    void use() const;
    /// Compute: uses the program and runs at least `items` invocations along x, y, z, in whole work groups
    /// (the shader ignores those beyond). What it wrote is visible to others after a glMemoryBarrier.
    void dispatch(const glm::ivec3& items) const;
    /// The same with the numbers of work groups along x, y, z (uint32) that `groups` holds at `offset`, a
    /// multiple of 4: what wrote them needs a GL_COMMAND_BARRIER_BIT before.
    void dispatchIndirect(const Buffer& groups, std::size_t offset) const;
    /// Compute: invocations of a work group along x, y, z; 0 where the program has no compute stage.
    const glm::ivec3& groupSize() const { return groupSize_; }
    /// Names of active inputs that were never set; empty when use() would succeed.
    std::vector<std::string> unsetInputs() const;

    /// For sources that a user edits while the program runs: from now on, inputs that the shader lacks, has
    /// as another type or has beyond those that are set (they are 0) are bad input, kept for
    /// takeMismatches(), and no broken promise.
    void tolerateMismatches() { tolerant_ = true; }
    /// What did not fit since the last call, one line each.
    std::vector<std::string> takeMismatches();

private:
    struct Input { // one active uniform, sampler, image, storage or uniform block
        GLint location = -1;
        GLenum type = 0;
        GLint count = 1; // elements of an array
        bool isSet = false;
        int unit = -1;                     // samplers, images; a block's binding
        GLuint textureId = 0;              // samplers and images
        GLuint bufferId = 0;               // blocks
        std::size_t offset = 0, bytes = 0; // uniform blocks
        GLenum imageAccess = 0, imageFormat = 0;
    };
    /// The input to set, or null for one that the compiler removed; aborts on an unknown name or another
    /// type.
    Input* find(const std::string& name, std::initializer_list<GLenum> types, std::size_t count = 1);
    Input* findTexture(const std::string& name, std::initializer_list<GLenum> types, const Handle& texture);
    Status listInputs();
    void listBlocks(GLenum kind);
    /// Aborts unless mismatches are tolerated.
    void mismatch(const std::string& what) const;

    std::map<std::string, Input> inputs_;
    std::string name_;   // stages, for messages
    std::string source_; // all stages, to tell an inactive name from an unknown one
    glm::ivec3 groupSize_{0};
    bool tolerant_ = false;
    mutable std::set<std::string> mismatches_;
};

/// Uniform blocks begin at multiples of this many bytes of their buffers.
std::size_t uniformOffsetStep();

/// Draws one triangle that covers the viewport (pass.vert makes it from gl_VertexID): what every state pass
/// uses.
void drawFullScreen(const VertexArray& emptyVertexArray);

} // namespace serosa::gpu
