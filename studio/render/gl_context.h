#pragma once

#include <GL/glcorearb.h>

#include <memory>

#include "core/model/result.h"

namespace ctpm::render {

/// Every OpenGL 3.3 entry point that the renderer uses: X(type, name).
// One entry a line.
// clang-format off
#define CTPM_GL_ENTRY_POINTS(X) \
  X(PFNGLACTIVETEXTUREPROC, ActiveTexture) \
  X(PFNGLATTACHSHADERPROC, AttachShader) \
  X(PFNGLBINDBUFFERPROC, BindBuffer) \
  X(PFNGLBINDFRAMEBUFFERPROC, BindFramebuffer) \
  X(PFNGLBINDRENDERBUFFERPROC, BindRenderbuffer) \
  X(PFNGLBINDTEXTUREPROC, BindTexture) \
  X(PFNGLBINDVERTEXARRAYPROC, BindVertexArray) \
  X(PFNGLBLENDFUNCPROC, BlendFunc) \
  X(PFNGLBLITFRAMEBUFFERPROC, BlitFramebuffer) \
  X(PFNGLBUFFERDATAPROC, BufferData) \
  X(PFNGLBUFFERSUBDATAPROC, BufferSubData) \
  X(PFNGLCHECKFRAMEBUFFERSTATUSPROC, CheckFramebufferStatus) \
  X(PFNGLCLEARPROC, Clear) \
  X(PFNGLCLEARCOLORPROC, ClearColor) \
  X(PFNGLCOLORMASKPROC, ColorMask) \
  X(PFNGLCOMPILESHADERPROC, CompileShader) \
  X(PFNGLCREATEPROGRAMPROC, CreateProgram) \
  X(PFNGLCREATESHADERPROC, CreateShader) \
  X(PFNGLDELETEBUFFERSPROC, DeleteBuffers) \
  X(PFNGLDELETEFRAMEBUFFERSPROC, DeleteFramebuffers) \
  X(PFNGLDELETEPROGRAMPROC, DeleteProgram) \
  X(PFNGLDELETERENDERBUFFERSPROC, DeleteRenderbuffers) \
  X(PFNGLDELETESHADERPROC, DeleteShader) \
  X(PFNGLDELETETEXTURESPROC, DeleteTextures) \
  X(PFNGLDELETEVERTEXARRAYSPROC, DeleteVertexArrays) \
  X(PFNGLDEPTHFUNCPROC, DepthFunc) \
  X(PFNGLDEPTHMASKPROC, DepthMask) \
  X(PFNGLDISABLEPROC, Disable) \
  X(PFNGLDRAWARRAYSPROC, DrawArrays) \
  X(PFNGLDRAWELEMENTSPROC, DrawElements) \
  X(PFNGLDRAWARRAYSINSTANCEDPROC, DrawArraysInstanced) \
  X(PFNGLENABLEPROC, Enable) \
  X(PFNGLENABLEVERTEXATTRIBARRAYPROC, EnableVertexAttribArray) \
  X(PFNGLFLUSHPROC, Flush) \
  X(PFNGLFRAMEBUFFERRENDERBUFFERPROC, FramebufferRenderbuffer) \
  X(PFNGLFRAMEBUFFERTEXTURE2DPROC, FramebufferTexture2D) \
  X(PFNGLGENBUFFERSPROC, GenBuffers) \
  X(PFNGLGENFRAMEBUFFERSPROC, GenFramebuffers) \
  X(PFNGLGENRENDERBUFFERSPROC, GenRenderbuffers) \
  X(PFNGLGENTEXTURESPROC, GenTextures) \
  X(PFNGLGENVERTEXARRAYSPROC, GenVertexArrays) \
  X(PFNGLGETERRORPROC, GetError) \
  X(PFNGLGETINTEGERVPROC, GetIntegerv) \
  X(PFNGLGETPROGRAMINFOLOGPROC, GetProgramInfoLog) \
  X(PFNGLGETPROGRAMIVPROC, GetProgramiv) \
  X(PFNGLGETSHADERINFOLOGPROC, GetShaderInfoLog) \
  X(PFNGLGETSHADERIVPROC, GetShaderiv) \
  X(PFNGLGETSTRINGPROC, GetString) \
  X(PFNGLGETUNIFORMLOCATIONPROC, GetUniformLocation) \
  X(PFNGLLINKPROGRAMPROC, LinkProgram) \
  X(PFNGLPIXELSTOREIPROC, PixelStorei) \
  X(PFNGLREADPIXELSPROC, ReadPixels) \
  X(PFNGLRENDERBUFFERSTORAGEPROC, RenderbufferStorage) \
  X(PFNGLSCISSORPROC, Scissor) \
  X(PFNGLSHADERSOURCEPROC, ShaderSource) \
  X(PFNGLSTENCILFUNCPROC, StencilFunc) \
  X(PFNGLSTENCILOPPROC, StencilOp) \
  X(PFNGLSTENCILOPSEPARATEPROC, StencilOpSeparate) \
  X(PFNGLTEXIMAGE2DPROC, TexImage2D) \
  X(PFNGLTEXIMAGE3DPROC, TexImage3D) \
  X(PFNGLTEXPARAMETERIPROC, TexParameteri) \
  X(PFNGLUNIFORM1FPROC, Uniform1f) \
  X(PFNGLUNIFORM1IPROC, Uniform1i) \
  X(PFNGLUNIFORM2FPROC, Uniform2f) \
  X(PFNGLUNIFORM3FPROC, Uniform3f) \
  X(PFNGLUNIFORM4FPROC, Uniform4f) \
  X(PFNGLUNIFORMMATRIX4FVPROC, UniformMatrix4fv) \
  X(PFNGLUSEPROGRAMPROC, UseProgram) \
  X(PFNGLVERTEXATTRIBDIVISORPROC, VertexAttribDivisor) \
  X(PFNGLVERTEXATTRIBPOINTERPROC, VertexAttribPointer) \
  X(PFNGLVIEWPORTPROC, Viewport)
// clang-format on

/// The entry points, loaded from OSMesa after a context was created.
struct Gl {
#define CTPM_GL_MEMBER(type, name) type name = nullptr;
  CTPM_GL_ENTRY_POINTS(CTPM_GL_MEMBER)
#undef CTPM_GL_MEMBER
};

/// An OpenGL 3.3 core context in memory: no display, no GPU.
class GlContext {
 public:
  /// Errors: OSMesa cannot create such a context, or lacks an entry point.
  static Result<std::unique_ptr<GlContext>> create();
  ~GlContext();

  /// Makes this context current in the calling thread, unless it already is.
  void make_current();

  const Gl& gl() const { return gl_; }

 private:
  GlContext() = default;
  void* context_ = nullptr;
  alignas(16) unsigned char pixels_[16 * 16 * 4] = {};  ///< OSMesa needs a buffer; pictures use framebuffer objects
  Gl gl_;
};

}  // namespace ctpm::render
