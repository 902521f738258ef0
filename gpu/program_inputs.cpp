// The inputs of a program: what the linker kept, typed setters, binding.

#include "base/check.h"
#include "gpu/program.h"
#include "gpu/sampled_texture.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

namespace serosa::gpu {

namespace {

constexpr GLenum kSamplers[] = {GL_SAMPLER_2D,        GL_INT_SAMPLER_2D, GL_UNSIGNED_INT_SAMPLER_2D,
                                GL_SAMPLER_2D_SHADOW, GL_SAMPLER_3D,     GL_UNSIGNED_INT_SAMPLER_3D};
constexpr GLenum kImages[] = {GL_IMAGE_2D, GL_INT_IMAGE_2D, GL_UNSIGNED_INT_IMAGE_2D,
                              GL_UNSIGNED_INT_IMAGE_3D, GL_IMAGE_3D};

bool isSampler(GLenum type) {
    return std::find(std::begin(kSamplers), std::end(kSamplers), type) != std::end(kSamplers);
}
bool isImage(GLenum type) {
    return std::find(std::begin(kImages), std::end(kImages), type) != std::end(kImages);
}

bool isWordCharacter(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// Whether the identifier stands in `source` as a whole word.
bool mentions(const std::string& source, const std::string& identifier) {
    for (std::size_t at = source.find(identifier); at != std::string::npos;
         at = source.find(identifier, at + 1)) {
        const std::size_t end = at + identifier.size();
        if ((at == 0 || !isWordCharacter(source[at - 1])) &&
            (end == source.size() || !isWordCharacter(source[end])))
            return true;
    }
    return false;
}

} // namespace

Status Program::listInputs() {
    GLint count = 0, longest = 0;
    glGetProgramiv(id_, GL_ACTIVE_UNIFORMS, &count);
    glGetProgramiv(id_, GL_ACTIVE_UNIFORM_MAX_LENGTH, &longest);
    int textureUnits = 0, imageUnits = 0;
    for (GLint index = 0; index < count; ++index) {
        std::string name(static_cast<std::size_t>(longest), '\0');
        GLsizei length = 0;
        Input input;
        glGetActiveUniform(id_, static_cast<GLuint>(index), longest, &length, &input.count, &input.type,
                           name.data());
        name.resize(static_cast<std::size_t>(length));
        input.location = glGetUniformLocation(id_, name.c_str());
        if (input.location < 0)
            continue; // in a uniform block, or the driver's own
        if (name.ends_with("[0]"))
            name.resize(name.size() - 3);
        if (isSampler(input.type) || isImage(input.type)) {
            if (input.count != 1)
                return Error{name_ + ": " + name + ": arrays of samplers and images are not supported"};
            input.unit = isSampler(input.type) ? textureUnits++ : imageUnits++;
            glProgramUniform1i(id_, input.location, input.unit);
        }
        inputs_.emplace(name, input);
    }
    return {};
}

void Program::listBlocks(GLenum kind) {
    const bool storage = kind == GL_SHADER_STORAGE_BLOCK;
    GLint count = 0, longest = 0;
    glGetProgramInterfaceiv(id_, kind, GL_ACTIVE_RESOURCES, &count);
    glGetProgramInterfaceiv(id_, kind, GL_MAX_NAME_LENGTH, &longest);
    for (GLint index = 0; index < count; ++index) {
        std::string name(static_cast<std::size_t>(longest), '\0');
        GLsizei length = 0;
        glGetProgramResourceName(id_, kind, static_cast<GLuint>(index), longest, &length, name.data());
        name.resize(static_cast<std::size_t>(length));
        Input input;
        input.type = storage ? GL_SHADER_STORAGE_BUFFER : GL_UNIFORM_BUFFER;
        input.unit = index;
        if (storage)
            glShaderStorageBlockBinding(id_, static_cast<GLuint>(index), static_cast<GLuint>(index));
        else
            glUniformBlockBinding(id_, static_cast<GLuint>(index), static_cast<GLuint>(index));
        inputs_.emplace(name, input);
    }
}

void Program::mismatch(const std::string& what) const {
    SEROSA_CHECK(tolerant_, name_ + what);
    mismatches_.insert(name_ + what);
}

std::vector<std::string> Program::takeMismatches() {
    const std::set<std::string> taken = std::exchange(mismatches_, {});
    return {taken.begin(), taken.end()};
}

Program::Input* Program::find(const std::string& name, std::initializer_list<GLenum> types,
                              std::size_t count) {
    const auto found = inputs_.find(name);
    if (found == inputs_.end()) {
        const std::string identifier = name.substr(0, name.find_first_of(".["));
        if (!mentions(source_, identifier))
            mismatch(" has no input \"" + name + "\"");
        return nullptr;
    }
    Input& input = found->second;
    input.isSet = true;
    if (std::find(types.begin(), types.end(), input.type) == types.end()) {
        mismatch(": input \"" + name + "\" is of another type in the shader");
        return nullptr;
    }
    if (count < static_cast<std::size_t>(input.count)) {
        mismatch(": input \"" + name + "\" has " + std::to_string(input.count) + " elements, " +
                 std::to_string(count) + " were given");
        return nullptr;
    }
    return &input;
}

Program& Program::set(const std::string& name, float value) {
    if (const Input* input = find(name, {GL_FLOAT}))
        glProgramUniform1f(id_, input->location, value);
    return *this;
}

Program& Program::set(const std::string& name, int value) {
    if (const Input* input = find(name, {GL_INT, GL_BOOL}))
        glProgramUniform1i(id_, input->location, value);
    return *this;
}

Program& Program::set(const std::string& name, unsigned value) {
    if (const Input* input = find(name, {GL_UNSIGNED_INT, GL_BOOL}))
        glProgramUniform1ui(id_, input->location, value);
    return *this;
}

Program& Program::set(const std::string& name, const glm::vec2& value) {
    if (const Input* input = find(name, {GL_FLOAT_VEC2}))
        glProgramUniform2fv(id_, input->location, 1, glm::value_ptr(value));
    return *this;
}

Program& Program::set(const std::string& name, const glm::vec3& value) {
    if (const Input* input = find(name, {GL_FLOAT_VEC3}))
        glProgramUniform3fv(id_, input->location, 1, glm::value_ptr(value));
    return *this;
}

Program& Program::set(const std::string& name, const glm::vec4& value) {
    if (const Input* input = find(name, {GL_FLOAT_VEC4}))
        glProgramUniform4fv(id_, input->location, 1, glm::value_ptr(value));
    return *this;
}

Program& Program::set(const std::string& name, const glm::ivec2& value) {
    if (const Input* input = find(name, {GL_INT_VEC2}))
        glProgramUniform2iv(id_, input->location, 1, glm::value_ptr(value));
    return *this;
}

Program& Program::set(const std::string& name, const glm::ivec3& value) {
    if (const Input* input = find(name, {GL_INT_VEC3}))
        glProgramUniform3iv(id_, input->location, 1, glm::value_ptr(value));
    return *this;
}

Program& Program::set(const std::string& name, const glm::mat3& value) {
    if (const Input* input = find(name, {GL_FLOAT_MAT3}))
        glProgramUniformMatrix3fv(id_, input->location, 1, GL_FALSE, glm::value_ptr(value));
    return *this;
}

Program& Program::set(const std::string& name, const glm::mat4& value) {
    if (const Input* input = find(name, {GL_FLOAT_MAT4}))
        glProgramUniformMatrix4fv(id_, input->location, 1, GL_FALSE, glm::value_ptr(value));
    return *this;
}

Program& Program::set(const std::string& name, std::span<const float> values) {
    if (const Input* input = find(name, {GL_FLOAT}, values.size()))
        glProgramUniform1fv(id_, input->location, input->count, values.data());
    return *this;
}

Program& Program::set(const std::string& name, std::span<const int> values) {
    if (const Input* input = find(name, {GL_INT}, values.size()))
        glProgramUniform1iv(id_, input->location, input->count, values.data());
    return *this;
}

Program& Program::set(const std::string& name, std::span<const glm::vec4> values) {
    if (const Input* input = find(name, {GL_FLOAT_VEC4}, values.size()))
        glProgramUniform4fv(id_, input->location, input->count, glm::value_ptr(values.front()));
    return *this;
}

Program::Input* Program::findTexture(const std::string& name, std::initializer_list<GLenum> types,
                                     const Handle& texture) {
    Input* input = find(name, types);
    if (input) {
        SEROSA_CHECK(texture, name_ + ": input \"" + name + "\" was given an empty texture");
        input->textureId = texture.id();
    }
    return input;
}

Program& Program::texture(const std::string& name, const Texture2D& texture) {
    findTexture(name, {GL_SAMPLER_2D, GL_INT_SAMPLER_2D, GL_UNSIGNED_INT_SAMPLER_2D, GL_SAMPLER_2D_SHADOW},
                texture);
    return *this;
}

Program& Program::texture(const std::string& name, const Texture3D& texture) {
    findTexture(name, {GL_SAMPLER_3D, GL_UNSIGNED_INT_SAMPLER_3D}, texture);
    return *this;
}

Program& Program::texture(const std::string& name, const TiledTexture& texture) {
    findTexture(name, {GL_SAMPLER_2D}, texture);
    return *this;
}

Program& Program::image(const std::string& name, const Texture2D& texture, GLenum access) {
    if (Input* input = findTexture(name, {GL_IMAGE_2D, GL_INT_IMAGE_2D, GL_UNSIGNED_INT_IMAGE_2D}, texture)) {
        input->imageAccess = access;
        input->imageFormat = texture.format();
    }
    return *this;
}

Program& Program::image(const std::string& name, const Texture3D& texture, GLenum access) {
    if (Input* input = findTexture(name, {GL_UNSIGNED_INT_IMAGE_3D, GL_IMAGE_3D}, texture)) {
        input->imageAccess = access;
        input->imageFormat = input->type == GL_IMAGE_3D ? texture.format() : GL_R32UI;
    }
    return *this;
}

Program& Program::buffer(const std::string& name, const Buffer& buffer) {
    if (Input* input = find(name, {GL_SHADER_STORAGE_BUFFER})) {
        SEROSA_CHECK(buffer, name_ + ": input \"" + name + "\" was given an empty buffer");
        input->bufferId = buffer.id();
    }
    return *this;
}

Program& Program::uniforms(const std::string& name, const Buffer& buffer, std::size_t offset,
                           std::size_t bytes) {
    if (Input* input = find(name, {GL_UNIFORM_BUFFER})) {
        SEROSA_CHECK(buffer && offset <= buffer.bytes() && bytes <= buffer.bytes() - offset,
                     name_ + ": input \"" + name + "\" lies beyond its buffer");
        input->bufferId = buffer.id();
        input->offset = offset;
        input->bytes = bytes;
    }
    return *this;
}

std::size_t uniformOffsetStep() {
    GLint step = 0;
    glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &step);
    return step > 0 ? static_cast<std::size_t>(step) : 256;
}

std::vector<std::string> Program::unsetInputs() const {
    std::vector<std::string> names;
    for (const auto& [name, input] : inputs_)
        if (!input.isSet)
            names.push_back(name);
    return names;
}

void Program::use() const {
    SEROSA_CHECK(id_, "use of an empty program");
    for (const auto& [name, input] : inputs_) {
        if (!input.isSet)
            mismatch(": input \"" + name + "\" was never set");
        if (input.unit < 0 || (tolerant_ && input.textureId == 0 && input.bufferId == 0))
            continue;
        if (input.type == GL_SHADER_STORAGE_BUFFER || input.type == GL_UNIFORM_BUFFER) {
            SEROSA_CHECK(glIsBuffer(input.bufferId),
                         name_ + ": the buffer of input \"" + name + "\" is gone");
            if (input.type == GL_SHADER_STORAGE_BUFFER)
                glBindBufferBase(input.type, static_cast<GLuint>(input.unit), input.bufferId);
            else
                glBindBufferRange(input.type, static_cast<GLuint>(input.unit), input.bufferId,
                                  static_cast<GLintptr>(input.offset), static_cast<GLsizeiptr>(input.bytes));
            continue;
        }
        SEROSA_CHECK(glIsTexture(input.textureId), name_ + ": the texture of input \"" + name + "\" is gone");
        const auto unit = static_cast<GLuint>(input.unit);
        if (isImage(input.type))
            glBindImageTexture(unit, input.textureId, 0,
                               input.type == GL_UNSIGNED_INT_IMAGE_3D || input.type == GL_IMAGE_3D, 0,
                               input.imageAccess, input.imageFormat);
        else
            glBindTextureUnit(unit, input.textureId);
    }
    glUseProgram(id_);
}

} // namespace serosa::gpu
