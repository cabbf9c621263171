// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/peers/llvmpipe.h"

#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <stdexcept>
#include <utility>

#include <GL/osmesa.h>
// After osmesa.h, which includes gl.h.
#include <GL/glext.h>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>

#include "chunker/pixel.h"
#include "layers/state.h"

namespace talisman::bench {
namespace {

template <typename Function>
Function loaded(const char* name) {
  const auto address = reinterpret_cast<Function>(OSMesaGetProcAddress(name));
  if (address == nullptr) throw std::runtime_error(std::string("OSMesa has no ") + name);
  return address;
}

constexpr const char* kVertexShader = R"(#version 120
attribute vec3 position; attribute vec3 normal; attribute vec2 place;
uniform mat4 clip_from_mesh; uniform mat4 world_from_mesh;
uniform vec3 ambient; uniform vec3 sun; uniform vec3 to_sun;
varying vec3 light; varying vec2 uv;
void main() {
  gl_Position = clip_from_mesh * vec4(position, 1.0);
  vec3 n = normalize((world_from_mesh * vec4(normal, 0.0)).xyz);
  light = ambient + sun * max(dot(n, to_sun), 0.0);
  uv = place;
})";
constexpr const char* kFragmentShader = R"(#version 120
uniform sampler2D picture;
varying vec3 light; varying vec2 uv;
void main() { gl_FragColor = vec4(texture2D(picture, uv).rgb * light, 1.0); })";

/// Functions beyond OpenGL 1.1.
struct Functions {
  PFNGLCREATESHADERPROC create_shader = loaded<PFNGLCREATESHADERPROC>("glCreateShader");
  PFNGLSHADERSOURCEPROC shader_source = loaded<PFNGLSHADERSOURCEPROC>("glShaderSource");
  PFNGLCOMPILESHADERPROC compile_shader = loaded<PFNGLCOMPILESHADERPROC>("glCompileShader");
  PFNGLCREATEPROGRAMPROC create_program = loaded<PFNGLCREATEPROGRAMPROC>("glCreateProgram");
  PFNGLATTACHSHADERPROC attach_shader = loaded<PFNGLATTACHSHADERPROC>("glAttachShader");
  PFNGLBINDATTRIBLOCATIONPROC bind_attribute = loaded<PFNGLBINDATTRIBLOCATIONPROC>("glBindAttribLocation");
  PFNGLLINKPROGRAMPROC link_program = loaded<PFNGLLINKPROGRAMPROC>("glLinkProgram");
  PFNGLGETPROGRAMIVPROC get_program = loaded<PFNGLGETPROGRAMIVPROC>("glGetProgramiv");
  PFNGLUSEPROGRAMPROC use_program = loaded<PFNGLUSEPROGRAMPROC>("glUseProgram");
  PFNGLGETUNIFORMLOCATIONPROC uniform = loaded<PFNGLGETUNIFORMLOCATIONPROC>("glGetUniformLocation");
  PFNGLUNIFORM3FVPROC set_vec3 = loaded<PFNGLUNIFORM3FVPROC>("glUniform3fv");
  PFNGLUNIFORMMATRIX4FVPROC set_mat4 = loaded<PFNGLUNIFORMMATRIX4FVPROC>("glUniformMatrix4fv");
  PFNGLGENBUFFERSPROC gen_buffers = loaded<PFNGLGENBUFFERSPROC>("glGenBuffers");
  PFNGLBINDBUFFERPROC bind_buffer = loaded<PFNGLBINDBUFFERPROC>("glBindBuffer");
  PFNGLBUFFERDATAPROC buffer_data = loaded<PFNGLBUFFERDATAPROC>("glBufferData");
  PFNGLVERTEXATTRIBPOINTERPROC attribute = loaded<PFNGLVERTEXATTRIBPOINTERPROC>("glVertexAttribPointer");
  PFNGLENABLEVERTEXATTRIBARRAYPROC enable_attribute =
      loaded<PFNGLENABLEVERTEXATTRIBARRAYPROC>("glEnableVertexAttribArray");
  PFNGLGENFRAMEBUFFERSPROC gen_framebuffers = loaded<PFNGLGENFRAMEBUFFERSPROC>("glGenFramebuffers");
  PFNGLBINDFRAMEBUFFERPROC bind_framebuffer = loaded<PFNGLBINDFRAMEBUFFERPROC>("glBindFramebuffer");
  PFNGLGENRENDERBUFFERSPROC gen_renderbuffers = loaded<PFNGLGENRENDERBUFFERSPROC>("glGenRenderbuffers");
  PFNGLBINDRENDERBUFFERPROC bind_renderbuffer = loaded<PFNGLBINDRENDERBUFFERPROC>("glBindRenderbuffer");
  PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC samples_storage =
      loaded<PFNGLRENDERBUFFERSTORAGEMULTISAMPLEPROC>("glRenderbufferStorageMultisample");
  PFNGLFRAMEBUFFERRENDERBUFFERPROC attach_renderbuffer =
      loaded<PFNGLFRAMEBUFFERRENDERBUFFERPROC>("glFramebufferRenderbuffer");
  PFNGLCHECKFRAMEBUFFERSTATUSPROC check_framebuffer =
      loaded<PFNGLCHECKFRAMEBUFFERSTATUSPROC>("glCheckFramebufferStatus");
  PFNGLBLITFRAMEBUFFERPROC blit = loaded<PFNGLBLITFRAMEBUFFERPROC>("glBlitFramebuffer");
};

/// LP_NUM_THREADS 0: llvmpipe draws in the caller. It is read when the context is made.
OSMesaContext make_context() {
  setenv("LP_NUM_THREADS", "0", 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  const int wanted[] = {
      OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, OSMESA_PROFILE, OSMESA_COMPAT_PROFILE, 0};
  OSMesaContext context = OSMesaCreateContextAttribs(wanted, nullptr);
  if (context == nullptr) throw std::runtime_error("OSMesa gives no context");
  return context;
}

void upload_texture(const layers::Texture& texture) {
  std::vector<unsigned char> linear(texture.rgba.begin(), texture.rgba.end());
  for (std::size_t i = 0; i < linear.size(); ++i)
    if (i % 4 != 3) linear[i] = static_cast<unsigned char>(chunker::linear_from_srgb(linear[i]) * 255 + 0.5f);
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, texture.width, texture.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
               linear.data());
}

}  // namespace

struct Llvmpipe::Impl {
  OSMesaContext context = make_context();
  LinearBytes picture = LinearBytes(4 * static_cast<std::size_t>(kPicture.x) * kPicture.y);
  /// A context must be current before functions are asked for.
  bool current = OSMesaMakeCurrent(context, picture.data(), GL_UNSIGNED_BYTE, kPicture.x, kPicture.y) != 0;
  Functions gl;
  GLuint program = 0, samples = 0;
  GLsizei indices = 0;

  void compile();
  void upload_mesh(const layers::Mesh& mesh);
  void set_light(const layers::SceneFrame& frame);
  void make_samples();
};

void Llvmpipe::Impl::compile() {
  program = gl.create_program();
  for (const auto& [kind, text] :
       {std::pair{GL_VERTEX_SHADER, kVertexShader}, {GL_FRAGMENT_SHADER, kFragmentShader}}) {
    const GLuint shader = gl.create_shader(kind);
    gl.shader_source(shader, 1, &text, nullptr);
    gl.compile_shader(shader);
    gl.attach_shader(program, shader);
  }
  GLuint slot = 0;
  for (const char* name : {"position", "normal", "place"}) gl.bind_attribute(program, slot++, name);
  gl.link_program(program);
  GLint linked = 0;
  gl.get_program(program, GL_LINK_STATUS, &linked);
  if (linked == 0) throw std::runtime_error("llvmpipe does not link the program");
  gl.use_program(program);
}

void Llvmpipe::Impl::upload_mesh(const layers::Mesh& mesh) {
  std::vector<float> vertices;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const layers::vec3 p = mesh.positions[i], n = mesh.normals[i];
    vertices.insert(vertices.end(), {p.x, p.y, p.z, n.x, n.y, n.z, mesh.uvs[i].x, mesh.uvs[i].y});
  }
  GLuint buffers[2];
  gl.gen_buffers(2, buffers);
  gl.bind_buffer(GL_ARRAY_BUFFER, buffers[0]);
  gl.buffer_data(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(float)), vertices.data(),
                 GL_STATIC_DRAW);
  gl.bind_buffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  gl.buffer_data(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(mesh.indices.size() * sizeof(std::uint32_t)), mesh.indices.data(),
                 GL_STATIC_DRAW);
  for (GLuint k = 0; k < 3; ++k) {
    gl.enable_attribute(k);
    gl.attribute(k, k == 2 ? 2 : 3, GL_FLOAT, GL_FALSE, 32,
                 reinterpret_cast<const void*>(std::uintptr_t{12} * k));
  }
  indices = static_cast<GLsizei>(mesh.indices.size());
}

void Llvmpipe::Impl::set_light(const layers::SceneFrame& frame) {
  const layers::Part& part = frame.scene->parts[0];
  const glm::mat4 world(frame.world_from_node[part.node]);
  const glm::mat4 clip(layers::clip_from_world(frame.camera, kPicture) * frame.world_from_node[part.node]);
  gl.set_mat4(gl.uniform(program, "world_from_mesh"), 1, GL_FALSE, glm::value_ptr(world));
  gl.set_mat4(gl.uniform(program, "clip_from_mesh"), 1, GL_FALSE, glm::value_ptr(clip));
  const layers::vec3 base = frame.scene->materials[part.material].base_color;
  for (const layers::LightState& light : frame.lights) {
    const bool ambient = light.kind == layers::Light::Kind::Ambient;
    const layers::vec3 color = base * light.color, to_sun(-light.direction);
    gl.set_vec3(gl.uniform(program, ambient ? "ambient" : "sun"), 1, glm::value_ptr(color));
    if (!ambient) gl.set_vec3(gl.uniform(program, "to_sun"), 1, glm::value_ptr(to_sun));
  }
}

void Llvmpipe::Impl::make_samples() {
  GLuint buffers[2];
  gl.gen_framebuffers(1, &samples);
  gl.gen_renderbuffers(2, buffers);
  gl.bind_framebuffer(GL_FRAMEBUFFER, samples);
  for (const auto& [buffer, format, place] : {std::tuple{buffers[0], GL_RGBA8, GL_COLOR_ATTACHMENT0},
                                              {buffers[1], GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT}}) {
    gl.bind_renderbuffer(GL_RENDERBUFFER, buffer);
    gl.samples_storage(GL_RENDERBUFFER, 4, format, kPicture.x, kPicture.y);
    gl.attach_renderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer);
  }
  GLint count = 0;
  glGetIntegerv(GL_SAMPLES, &count);
  if (gl.check_framebuffer(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE || count != 4)
    throw std::runtime_error("llvmpipe gives no frame buffer of 4 samples");
}

Llvmpipe::Llvmpipe(const layers::SceneFrame& frame) : impl_(std::make_unique<Impl>()) {
  const std::string renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (renderer.find("llvmpipe") == std::string::npos)
    throw std::runtime_error("OSMesa draws with " + renderer + ", not with llvmpipe");
  OSMesaPixelStore(OSMESA_Y_UP, 0);
  const layers::Part& part = frame.scene->parts[0];
  impl_->compile();
  impl_->set_light(frame);
  upload_texture(frame.scene->textures[frame.scene->materials[part.material].texture]);
  impl_->upload_mesh(frame.scene->meshes[part.mesh]);
  impl_->make_samples();
  glViewport(0, 0, kPicture.x, kPicture.y);
  glEnable(GL_DEPTH_TEST);
  if (!frame.scene->materials[part.material].two_sided) glEnable(GL_CULL_FACE);
  glClearColor(0, 0, 0, 0);
}

Llvmpipe::~Llvmpipe() { OSMesaDestroyContext(impl_->context); }

void Llvmpipe::draw(bool four_samples) {
  impl_->gl.bind_framebuffer(GL_FRAMEBUFFER, four_samples ? impl_->samples : 0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDrawElements(GL_TRIANGLES, impl_->indices, GL_UNSIGNED_INT, nullptr);
  if (four_samples) {
    impl_->gl.bind_framebuffer(GL_READ_FRAMEBUFFER, impl_->samples);
    impl_->gl.bind_framebuffer(GL_DRAW_FRAMEBUFFER, 0);
    impl_->gl.blit(0, 0, kPicture.x, kPicture.y, 0, 0, kPicture.x, kPicture.y, GL_COLOR_BUFFER_BIT,
                   GL_NEAREST);
  }
  glFinish();
}

const LinearBytes& Llvmpipe::picture() const { return impl_->picture; }

}  // namespace talisman::bench
