// Drawing of coloured surfaces: places are cut by a plane of the initial shape, back faces of solids have one colour.
const SHADERS = [`
precision highp float;
attribute vec3 point, displacement; attribute float value;
uniform mat3 turn; uniform vec3 centre; uniform vec2 shift, aspect; uniform float zoom, amount, plain, depth;
varying vec3 place, initial; varying float shown;
void main() {
  place = turn * (point + amount * displacement - centre);
  initial = point;
  shown = value;
  gl_Position = vec4((place.xy * zoom + shift) * aspect, -depth * place.z - 0.0008 * plain, 1.0);
}`, `
#extension GL_OES_standard_derivatives : enable
precision highp float;
uniform sampler2D map; uniform vec4 plane; uniform vec2 limits; uniform float plain, solid, cuts, lip;
varying vec3 place, initial; varying float shown;
void main() {
  if (cuts > 0.5 && dot(plane.xyz, initial) > plane.w + lip) discard;
  if (plain > 0.5) { gl_FragColor = vec4(0.08, 0.09, 0.13, 0.45); return; }
  if (solid > 0.5 && !gl_FrontFacing) { gl_FragColor = vec4(0.62, 0.64, 0.68, 1.0); return; }
  vec3 normal = cross(dFdx(place), dFdy(place));
  float light = length(normal) > 0.0 ? 0.74 + 0.26 * abs(normalize(normal).z) : 1.0;
  vec3 colour = shown < -1e37 ? vec3(0.8) : texture2D(map, vec2(clamp((shown - limits.x) / (limits.y - limits.x), 0.002, 0.998), 0.5)).rgb;
  gl_FragColor = vec4(light * colour, 1.0);
}`];
const BACKGROUND = [244, 246, 249], NO_VALUE = -3e38;

function program(gl) {
  const made = gl.createProgram();
  for (const [at, source] of SHADERS.entries()) {
    const shader = gl.createShader(at ? gl.FRAGMENT_SHADER : gl.VERTEX_SHADER);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  gl.useProgram(made);
  return made;
}

// The colour map as 256 colours of a texture.
function texture(gl) {
  const all = new Uint8Array(1024), last = colours.length - 1;
  for (let at = 0; at < 256; at += 1) {
    const place = (at / 255) * last, first = Math.min(Math.floor(place), last - 1);
    for (let c = 0; c < 3; c += 1) all[4 * at + c] = Math.round(colours[first][c] + (place - first) * (colours[first + 1][c] - colours[first][c]));
    all[4 * at + 3] = 255;
  }
  gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, all);
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.LINEAR);
  for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, side, gl.CLAMP_TO_EDGE);
}

// A canvas with buffers of the surface and of the cut; null without WebGL.
function painter(canvas, view, points) {
  const gl = canvas.getContext("webgl", { alpha: false, antialias: true, preserveDrawingBuffer: true });
  if (!gl) return null;
  gl.getExtension("OES_standard_derivatives");
  gl.getExtension("OES_element_index_uint");
  const made = program(gl), uniform = (name) => gl.getUniformLocation(made, name);
  texture(gl);
  const buffers = {};
  const store = (name, data, kind = gl.ARRAY_BUFFER) => {
    buffers[name] = buffers[name] || gl.createBuffer();
    gl.bindBuffer(kind, buffers[name]);
    gl.bufferData(kind, data, gl.STATIC_DRAW);
  };
  const use = (prefix) => ["point", "displacement", "value"].forEach((name) => {
    const at = gl.getAttribLocation(made, name);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[prefix + name]);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, name === "value" ? 1 : 3, gl.FLOAT, false, 0, 0);
  });
  const triangles = new Uint32Array(bytes(view.triangles)), edges = new Uint32Array(bytes(view.edges));
  store("triangles", triangles, gl.ELEMENT_ARRAY_BUFFER);
  store("edges", edges, gl.ELEMENT_ARRAY_BUFFER);
  store("point", points);
  return {
    gl, triangles, edges,
    fill(displacement, values) {
      store("displacement", displacement);
      store("value", Float32Array.from(values, (value) => (Number.isFinite(value) ? value : NO_VALUE)));
    },
    // `scene`: size of the canvas, turn, centre, shift, zoom, depth, amount, limits, plane, size of a pixel, bodies shown, edges, section.
    draw(scene) {
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.clearColor(...BACKGROUND.map((part) => part / 255), 1);
      gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
      gl.enable(gl.DEPTH_TEST);
      gl.uniformMatrix3fv(uniform("turn"), false, scene.turn);
      gl.uniform3fv(uniform("centre"), scene.centre);
      gl.uniform2fv(uniform("shift"), scene.shift);
      gl.uniform2fv(uniform("aspect"), scene.aspect);
      gl.uniform1f(uniform("zoom"), scene.zoom);
      gl.uniform1f(uniform("amount"), scene.amount);
      gl.uniform1f(uniform("depth"), scene.depth);
      gl.uniform2fv(uniform("limits"), scene.limits);
      gl.uniform4fv(uniform("plane"), scene.plane || [0, 0, 0, 0]);
      gl.uniform1f(uniform("cuts"), scene.plane ? 1 : 0);
      // Surfaces reach a pixel beyond a section, so that no gap opens between them.
      gl.uniform1f(uniform("lip"), scene.section ? scene.pixel : 0);
      gl.uniform1f(uniform("plain"), 0);
      gl.disable(gl.BLEND);
      gl.enable(gl.POLYGON_OFFSET_FILL);
      gl.polygonOffset(1, 1);
      use("");
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers.triangles);
      for (const body of scene.bodies) {
        gl.uniform1f(uniform("solid"), body.is_solid ? 1 : 0);
        gl.drawElements(gl.TRIANGLES, body.triangles[1], gl.UNSIGNED_INT, 4 * body.triangles[0]);
      }
      if (scene.edges) {
        gl.enable(gl.BLEND);
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
        gl.uniform1f(uniform("plain"), 1);
        gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers.edges);
        for (const body of scene.bodies) gl.drawElements(gl.LINES, body.edges[1], gl.UNSIGNED_INT, 4 * body.edges[0]);
        gl.uniform1f(uniform("plain"), 0);
        gl.disable(gl.BLEND);
      }
      if (scene.section && scene.section.value.length) {
        for (const name of ["point", "displacement", "value"]) store(`cut ${name}`, scene.section[name]);
        use("cut ");
        gl.uniform1f(uniform("solid"), 0);
        gl.uniform1f(uniform("cuts"), 0);
        gl.drawArrays(gl.TRIANGLES, 0, scene.section.value.length);
      }
    },
    // How many points of the canvas are not background; the page tells it for tests.
    coloured() {
      const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight], all = new Uint8Array(4 * width * height);
      gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, all);
      let count = 0;
      for (let at = 0; at < all.length; at += 4) if (Math.abs(all[at] - BACKGROUND[0]) + Math.abs(all[at + 1] - BACKGROUND[1]) + Math.abs(all[at + 2] - BACKGROUND[2]) > 20) count += 1;
      return count;
    },
  };
}
