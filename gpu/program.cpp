// Compiling and linking, the list of inputs, and the refusal to draw while one of them was never set.

#include "gpu/program.h"

#include "base/check.h"
#include "gpu/label.h"

#include <glm/gtc/type_ptr.hpp>

#include <array>
#include <utility>

namespace serosa::gpu {

namespace {

struct Stage {
    const char* suffix;
    GLenum type;
};
constexpr Stage kStages[] = {{".vert", GL_VERTEX_SHADER},          {".tesc", GL_TESS_CONTROL_SHADER},
                             {".tese", GL_TESS_EVALUATION_SHADER}, {".geom", GL_GEOMETRY_SHADER},
                             {".frag", GL_FRAGMENT_SHADER},        {".comp", GL_COMPUTE_SHADER}};

/// A shader object that dies with its scope.
class Shader : public Handle {
public:
    explicit Shader(GLenum type) { id_ = glCreateShader(type); }
    Shader(Shader&&) noexcept = default;
    ~Shader() {
        if (id_)
            glDeleteShader(id_);
    }
};

std::string shaderLog(GLuint id) {
    GLint length = 0;
    glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(id, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

std::string programLog(GLuint id) {
    GLint length = 0;
    glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetProgramInfoLog(id, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

Result<Shader> compile(const std::string& name, const ExpandedShader& expanded) {
    GLenum type = 0;
    for (const Stage& stage : kStages)
        if (name.ends_with(stage.suffix))
            type = stage.type;
    if (!type)
        return Error{name + ": the suffix names no stage; use .vert, .geom, .frag or .comp"};
    Shader shader(type);
    const char* text = expanded.source.c_str();
    glShaderSource(shader.id(), 1, &text, nullptr);
    glCompileShader(shader.id());
    GLint done = GL_FALSE;
    glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &done);
    if (!done)
        return Error{name + " does not compile:\n" + explainShaderLog(shaderLog(shader.id()), expanded)};
    return shader;
}

} // namespace

Program& Program::operator=(Program&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(inputs_, other.inputs_);
    std::swap(name_, other.name_);
    std::swap(source_, other.source_);
    std::swap(groupSize_, other.groupSize_);
    std::swap(tolerant_, other.tolerant_);
    std::swap(mismatches_, other.mismatches_);
    return *this;
}

Program::~Program() {
    if (id_) {
        checkContext("a program that dies");
        glDeleteProgram(id_);
    }
}

Result<Program> Program::create(const ShaderLibrary& library, const std::vector<std::string>& stages,
                                const std::vector<ShaderDefine>& defines,
                                const std::vector<std::string>& feedback) {
    checkContext("a program");
    Program program;
    std::vector<Shader> shaders;
    for (const std::string& name : stages) {
        SEROSA_ASSIGN(const ExpandedShader expanded, library.expand(name, defines));
        SEROSA_ASSIGN(Shader shader, compile(name, expanded));
        shaders.push_back(std::move(shader));
        program.source_ += expanded.source;
        program.name_ += (program.name_.empty() ? "" : " + ") + name;
    }
    program.id_ = glCreateProgram();
    for (const Shader& shader : shaders)
        glAttachShader(program.id_, shader.id());
    if (!feedback.empty()) {
        std::vector<const char*> names;
        for (const std::string& name : feedback)
            names.push_back(name.c_str());
        glTransformFeedbackVaryings(program.id_, static_cast<GLsizei>(names.size()), names.data(),
                                    GL_INTERLEAVED_ATTRIBS);
    }
    glLinkProgram(program.id_);
    for (const Shader& shader : shaders)
        glDetachShader(program.id_, shader.id());
    GLint done = GL_FALSE;
    glGetProgramiv(program.id_, GL_LINK_STATUS, &done);
    if (!done)
        return Error{program.name_ + " does not link:\n" + programLog(program.id_)};
    labelObject(GL_PROGRAM, program.id_, program.name_);
    SEROSA_TRY(program.listInputs());
    program.listBlocks(GL_SHADER_STORAGE_BLOCK);
    program.listBlocks(GL_UNIFORM_BLOCK);
    if (stages.size() == 1 && stages.front().ends_with(".comp"))
        glGetProgramiv(program.id_, GL_COMPUTE_WORK_GROUP_SIZE, glm::value_ptr(program.groupSize_));
    return program;
}

void Program::dispatch(const glm::ivec3& items) const {
    SEROSA_CHECK(groupSize_.x > 0, name_ + " is dispatched and has no compute stage");
    glm::uvec3 groups(0);
    for (int axis = 0; axis < 3; ++axis) {
        SEROSA_CHECK(items[axis] > 0, name_ + ": a dispatch of nothing");
        groups[axis] = static_cast<GLuint>((items[axis] - 1) / groupSize_[axis] + 1);
        SEROSA_CHECK(groups[axis] <= 65535, name_ + ": more work groups than GL 4.5 promises");
    }
    use();
    glDispatchCompute(groups.x, groups.y, groups.z);
}

void Program::dispatchIndirect(const Buffer& groups, std::size_t offset) const {
    SEROSA_CHECK(groupSize_.x > 0, name_ + " is dispatched and has no compute stage");
    SEROSA_CHECK(groups && offset % 4 == 0 && offset + 12 <= groups.bytes(), name_ + ": three group counts");
    use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, groups.id());
    glDispatchComputeIndirect(static_cast<GLintptr>(offset));
}

void drawFullScreen(const VertexArray& emptyVertexArray) {
    glBindVertexArray(emptyVertexArray.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace serosa::gpu
