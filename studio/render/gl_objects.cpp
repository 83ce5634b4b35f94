#include "studio/render/gl_objects.h"

#include <algorithm>
#include <cmath>

namespace ctpm {
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

void VertexArray::attribute(const Gl& gl, GLuint slot, int floats, int offset, int stride,
                            GLuint divisor) const {
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

Result<Done> MultisampleTarget::create(const Gl& gl, int w, int h) {
  constexpr int kSamples = 4;
  width = w, height = h;
  GLuint colour[2], depth = 0;
  gl.GenFramebuffers(1, &framebuffer), gl.GenFramebuffers(1, &resolved);
  gl.GenRenderbuffers(2, colour), gl.GenRenderbuffers(1, &depth);
  const auto storage = [&](GLuint buffer, int samples, GLenum format) {
    gl.BindRenderbuffer(GL_RENDERBUFFER, buffer);
    gl.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, format, w, h);
  };
  storage(colour[0], kSamples, GL_RGBA8), storage(depth, kSamples, GL_DEPTH_COMPONENT24),
      storage(colour[1], 0, GL_RGBA8);
  bool complete = true;
  for (const GLuint target : {framebuffer, resolved}) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                               colour[target == resolved]);
    if (target == framebuffer)
      gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    complete = complete && gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }
  if (!complete || gl.GetError() != GL_NO_ERROR)
    return Error{"OpenGL",
                 "no picture of " + std::to_string(w) + "x" + std::to_string(h) + " can be drawn to",
                 "ask for a smaller picture"};
  return Done{};
}

void MultisampleTarget::begin(const Gl& gl) const {
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.Viewport(0, 0, width, height);
}

void MultisampleTarget::read(const Gl& gl, std::vector<std::uint8_t>& rgba) const {
  rgba.resize(std::size_t(width) * std::size_t(height) * 4);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer), gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved);
  gl.BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, resolved);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.ReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
}

void TextureTarget::create(const Gl& gl, int side) {
  size = side;
  gl.GenTextures(1, &texture), gl.GenFramebuffers(1, &framebuffer);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, size, size, 0, GL_RED, GL_UNSIGNED_BYTE, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR),
      gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE),
      gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
}

void TextureTarget::begin(const Gl& gl) const {
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.Viewport(0, 0, size, size);
}

GLuint create_noise_texture(const Gl& gl) {
  constexpr int kSize = 32, kCell = 4, kKnots = kSize / kCell;
  // Knot values from an integer hash, joined by quintic curves: smooth, and it repeats.
  const auto knot = [](int i, int j, int k) {
    std::uint32_t h = std::uint32_t(i & (kKnots - 1)) + 31u * std::uint32_t(j & (kKnots - 1)) +
                      1013u * std::uint32_t(k & (kKnots - 1));
    h = (h ^ 61u ^ (h >> 16)) * 9u, h = (h ^ (h >> 4)) * 0x27d4eb2du, h ^= h >> 15;
    return double(h & 0xffffu) / 32767.5 - 1;
  };
  const auto value = [&](int x, int y, int z) {
    const auto ease = [](double t) { return t * t * t * (t * (6 * t - 15) + 10); };
    const int i = x >> 2, j = y >> 2, k = z >> 2;
    const double u = ease((x & 3) / 4.0), v = ease((y & 3) / 4.0), w = ease((z & 3) / 4.0);
    double sum = 0;
    for (int n = 0; n < 8; ++n)
      sum += (n & 1 ? u : 1 - u) * (n & 2 ? v : 1 - v) * (n & 4 ? w : 1 - w) *
             knot(i + (n & 1), j + (n >> 1 & 1), k + (n >> 2));
    return sum;
  };
  std::vector<std::uint8_t> texels;
  const auto pack = [&](double x) {
    texels.push_back(std::uint8_t(std::lround(255 * std::clamp(0.5 + 0.5 * x, 0.0, 1.0))));
  };
  for (int z = 0; z < kSize; ++z)
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        pack(value(x + 1, y, z) - value(x - 1, y, z)), pack(value(x, y + 1, z) - value(x, y - 1, z));
        pack(value(x, y, z + 1) - value(x, y, z - 1)), pack(value(x, y, z));
      }
  GLuint texture = 0;
  gl.GenTextures(1, &texture), gl.BindTexture(GL_TEXTURE_3D, texture);
  gl.TexImage3D(GL_TEXTURE_3D, 0, GL_RGBA8, kSize, kSize, kSize, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels.data());
  gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MIN_FILTER, GL_LINEAR),
      gl.TexParameteri(GL_TEXTURE_3D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    gl.TexParameteri(GL_TEXTURE_3D, wrap, GL_REPEAT);
  return texture;
}

}  // namespace ctpm
