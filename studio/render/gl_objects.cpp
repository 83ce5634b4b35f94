#include "studio/render/gl_objects.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ctpm::render {
namespace {

std::string log_of(const Gl& gl, GLuint id, bool is_program) {
  char text[2048] = "";
  (is_program ? gl.GetProgramInfoLog : gl.GetShaderInfoLog)(id, sizeof text - 1, nullptr, text);
  return text;
}

GLuint compile(const Gl& gl, GLenum kind, const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const char* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  return shader;
}

}  // namespace

Result<Program> Program::create(const Gl& gl, const std::string& name, const std::string& vertex,
                                const std::string& fragment) {
  Program program;
  program.gl_ = &gl, program.id_ = gl.CreateProgram();
  const GLuint shaders[] = {compile(gl, GL_VERTEX_SHADER, vertex), compile(gl, GL_FRAGMENT_SHADER, fragment)};
  Errors errors;
  for (const GLuint shader : shaders) {
    GLint good = 0;
    gl.GetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) errors.push_back({"shader " + name, log_of(gl, shader, false), ""});
    gl.AttachShader(program.id_, shader);
  }
  GLint good = 0;
  if (errors.empty()) {
    gl.LinkProgram(program.id_);
    gl.GetProgramiv(program.id_, GL_LINK_STATUS, &good);
    if (!good) errors.push_back({"shader " + name, log_of(gl, program.id_, true), ""});
  }
  for (const GLuint shader : shaders) gl.DeleteShader(shader);
  if (!errors.empty()) return errors;
  return program;
}

void Program::set(const char* name, const Mat4& matrix) const {
  float values[16];
  std::copy(matrix.begin(), matrix.end(), values);
  gl_->UniformMatrix4fv(place(name), 1, GL_FALSE, values);
}

void VertexArray::create(const Gl& gl) {
  gl.GenVertexArrays(1, &id), gl.GenBuffers(1, &stream), gl.GenBuffers(1, &indices);
  gl.BindVertexArray(id);
  gl.BindBuffer(GL_ARRAY_BUFFER, stream), gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices);
}

void VertexArray::attribute(const Gl& gl, GLuint slot, int floats, int offset, int stride, GLuint divisor) const {
  gl.BindVertexArray(id), gl.BindBuffer(GL_ARRAY_BUFFER, stream);
  gl.EnableVertexAttribArray(slot);
  const std::size_t bytes = std::size_t(offset) * sizeof(float);
  gl.VertexAttribPointer(slot, floats, GL_FLOAT, GL_FALSE, stride * int(sizeof(float)),
                         reinterpret_cast<const void*>(bytes));
  if (divisor) gl.VertexAttribDivisor(slot, divisor);
}

void VertexArray::set_indices(const Gl& gl, std::span<const std::uint32_t> index) {
  gl.BindVertexArray(id);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(index.size_bytes()), index.data(), GL_STATIC_DRAW);
  index_count = GLsizei(index.size());
}

void VertexArray::set_stream(const Gl& gl, std::span<const float> data) {
  gl.BindBuffer(GL_ARRAY_BUFFER, stream);
  if (data.size_bytes() > stream_bytes) {
    stream_bytes = data.size_bytes();
    gl.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(stream_bytes), data.data(), GL_STREAM_DRAW);
  } else if (!data.empty()) {
    gl.BufferSubData(GL_ARRAY_BUFFER, 0, GLsizeiptr(data.size_bytes()), data.data());
  }
}

Result<Done> PictureTarget::create(const Gl& gl, int w, int h) {
  width = w, height = h;
  GLuint colour = 0;
  gl.GenFramebuffers(1, &framebuffer), gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  const auto attach = [&](GLuint& buffer, GLenum format, GLenum place) {
    gl.GenRenderbuffers(1, &buffer), gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl.RenderbufferStorage(GL_RENDERBUFFER, format, w, h);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  };
  attach(colour, GL_RGBA8, GL_COLOR_ATTACHMENT0), attach(depth, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE || gl.GetError() != GL_NO_ERROR)
    return Error{"OpenGL", "no picture of " + std::to_string(w) + "x" + std::to_string(h) + " can be drawn to",
                 "ask for a smaller picture"};
  return Done{};
}

void PictureTarget::need_stencil(const Gl& gl) {
  if (std::exchange(has_stencil, true)) return;
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer), gl.BindRenderbuffer(GL_RENDERBUFFER, depth);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH24_STENCIL8, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_STENCIL_ATTACHMENT, GL_RENDERBUFFER, depth);
  CTPM_CHECK(gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "a picture gets no stencil");
}

void PictureTarget::begin(const Gl& gl, const PixelRect& rect) const {
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.Viewport(0, 0, width, height);
  // All of it: a driver in software clears a part as slowly as it draws it.
  gl.Disable(GL_SCISSOR_TEST), gl.ClearColor(0, 0, 0, 0), gl.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  gl.Enable(GL_SCISSOR_TEST), gl.Scissor(rect.x, rect.y, rect.width, rect.height);
}

void PictureTarget::read(const Gl& gl, const PixelRect& rect, std::vector<std::uint8_t>& rgba) const {
  rgba.resize(std::size_t(rect.width) * std::size_t(rect.height) * 4);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.ReadPixels(rect.x, rect.y, rect.width, rect.height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

}  // namespace ctpm::render
