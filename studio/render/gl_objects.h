#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "core/vec3.h"
#include "studio/render/camera.h"
#include "studio/render/gl_context.h"

namespace ctpm {

/// A linked shader program.
class Program {
 public:
  Program() = default;
  /// Errors: the compiler's or linker's words; a bug of ours unless the driver is too old.
  static Result<Program> create(const Gl& gl, const std::string& name, const std::string& vertex,
                                const std::string& fragment);

  void use() const { gl_->UseProgram(id_); }
  GLuint id() const { return id_; }
  void set(const char* name, int value) const { gl_->Uniform1i(place(name), value); }
  void set(const char* name, double value) const { gl_->Uniform1f(place(name), float(value)); }
  void set(const char* name, Vec3 v) const {
    gl_->Uniform3f(place(name), float(v.x), float(v.y), float(v.z));
  }
  void set(const char* name, Vec3 v, double w) const {
    gl_->Uniform4f(place(name), float(v.x), float(v.y), float(v.z), float(w));
  }
  void set(const char* name, const Mat4& matrix) const;

 private:
  GLint place(const char* name) const { return gl_->GetUniformLocation(id_, name); }
  const Gl* gl_ = nullptr;
  GLuint id_ = 0;
};

/// Vertices in memory of the context: `stream` attributes change with every frame, indices seldom.
struct VertexArray {
  GLuint id = 0, stream = 0, indices = 0;
  std::size_t stream_bytes = 0;
  GLsizei index_count = 0;

  void create(const Gl& gl);
  /// Attribute `slot` reads `floats` floats at `offset` floats in each record of `stride` floats.
  void attribute(const Gl& gl, GLuint slot, int floats, int offset, int stride, GLuint divisor = 0) const;
  void set_indices(const Gl& gl, std::span<const std::uint32_t> index);
  void set_stream(const Gl& gl, std::span<const float> data);
};

/// A frame buffer with 4 samples per pixel, and what it resolves to.
struct MultisampleTarget {
  GLuint framebuffer = 0, resolved = 0;
  int width = 0, height = 0;

  /// Errors: the driver refuses the size.
  Result<Done> create(const Gl& gl, int width, int height);
  void begin(const Gl& gl) const;
  /// Resolves and reads the picture: RGBA, bottom row first.
  void read(const Gl& gl, std::vector<std::uint8_t>& rgba) const;
};

/// A square one-channel texture that can be drawn to.
struct TextureTarget {
  GLuint framebuffer = 0, texture = 0;
  int size = 0;

  void create(const Gl& gl, int size);
  void begin(const Gl& gl) const;
};

/// A texture of smooth noise that repeats: its gradient in rgb and its value in a, each as 0.5 + 0.5 x.
GLuint create_noise_texture(const Gl& gl);

}  // namespace ctpm
