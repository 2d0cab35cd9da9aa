// The deformed mesh: drag turns, the wheel zooms, drag with shift or the right button moves.
const SHADERS = [`
precision highp float;
attribute vec3 point, displacement; attribute float value;
uniform mat3 turn; uniform vec3 centre; uniform vec2 shift; uniform vec2 aspect; uniform float zoom, amount, plain;
varying vec3 place; varying float shown;
void main() {
  place = turn * (point + amount * displacement - centre);
  shown = value;
  gl_Position = vec4((place.xy * zoom + shift) * aspect, -0.2 * clamp(place.z * zoom, -4.0, 4.0) - 0.001 * plain, 1.0);
}`, `
#extension GL_OES_standard_derivatives : enable
precision highp float;
uniform vec2 limits; uniform float plain;
varying vec3 place; varying float shown;
vec3 colour(float t) {
  vec3 a = vec3(0.231, 0.298, 0.753), b = vec3(0.553, 0.690, 0.996), c = vec3(0.867), d = vec3(0.957, 0.596, 0.478), e = vec3(0.706, 0.016, 0.149);
  return t < 0.25 ? mix(a, b, 4.0 * t) : t < 0.5 ? mix(b, c, 4.0 * t - 1.0) : t < 0.75 ? mix(c, d, 4.0 * t - 2.0) : mix(d, e, 4.0 * t - 3.0);
}
void main() {
  if (plain > 0.5) { gl_FragColor = vec4(0.1, 0.12, 0.16, 1.0); return; }
  vec3 normal = cross(dFdx(place), dFdy(place));
  float light = length(normal) > 0.0 ? 0.55 + 0.45 * abs(normalize(normal).z) : 1.0;
  gl_FragColor = vec4(light * colour(clamp((shown - limits.x) / (limits.y - limits.x), 0.0, 1.0)), 1.0);
}`];
const BACKGROUND = [244, 246, 249];

function bytes(text) {
  return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer;
}

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

// The values of a field, or the sizes of its vectors.
function valuesOf(step, name, component) {
  const field = step.fields.find(([own]) => own === name);
  if (!field) return null;
  const [, components, text] = field, all = new Float32Array(bytes(text)), count = all.length / components;
  return Float32Array.from({ length: count }, (_, at) => {
    if (component !== "size") return all[at * components + Number(component)];
    return Math.hypot(...all.subarray(at * components, (at + 1) * components));
  });
}

function limitsOf(values) {
  let low = Infinity, high = -Infinity;
  for (const value of values) if (Number.isFinite(value)) { low = Math.min(low, value); high = Math.max(high, value); }
  return low <= high ? [low, high] : [0, 0];
}

function choice(title, options, act) {
  const list = element("select", {}, ...options.map(([value, words]) => element("option", { value }, words)));
  list.addEventListener("change", act);
  return [list, element("label", {}, `${title} `, list)];
}

function slider(title, attributes, act) {
  const made = element("input", { type: "range", ...attributes }), said = element("span");
  made.addEventListener("input", act);
  return [made, said, element("label", {}, `${title} `, made, " ", said)];
}

function show(view) {
  const canvas = element("canvas"), holder = element("div"), limits = element("span"), bar = element("div", { class: "bar" });
  const gl = canvas.getContext("webgl", { antialias: true, preserveDrawingBuffer: true });
  section(`Mesh ${view.name}`, holder);
  if (!gl) {
    root.dataset.webgl = "none";
    holder.append("This browser has no WebGL: the mesh is not drawn.");
    return;
  }
  gl.getExtension("OES_standard_derivatives");
  gl.getExtension("OES_element_index_uint");
  const made = program(gl), points = new Float32Array(bytes(view.points));
  const uniform = (name) => gl.getUniformLocation(made, name);
  const buffer = (kind, data) => { const own = gl.createBuffer(); gl.bindBuffer(kind, own); gl.bufferData(kind, data, gl.STATIC_DRAW); return own; };
  const attribute = (name, size, data) => {
    const at = gl.getAttribLocation(made, name);
    buffer(gl.ARRAY_BUFFER, data);
    gl.enableVertexAttribArray(at);
    gl.vertexAttribPointer(at, size, gl.FLOAT, false, 0, 0);
  };
  const box = [0, 1, 2].map((axis) => limitsOf(points.filter((_, at) => at % 3 === axis)));
  const centre = box.map(([low, high]) => (low + high) / 2), extent = Math.hypot(...box.map(([low, high]) => high - low)) || 1;
  const flat = box[2][1] - box[2][0] < 1e-9 * extent;
  const triangles = new Uint32Array(bytes(view.triangles)), edges = new Uint32Array(bytes(view.edges));
  const faces = buffer(gl.ELEMENT_ARRAY_BUFFER, triangles), wires = buffer(gl.ELEMENT_ARRAY_BUFFER, edges);
  attribute("point", 3, points);
  const state = { angles: flat ? [0, 0] : [-0.6, 0.5], zoom: 1.7 / extent, shift: [0, 0] };
  const last = view.steps[view.steps.length - 1];
  const [fieldList, fieldLabel] = choice("field", last.fields.map(([name]) => [name, name]), () => { components(); load(); });
  const [partList, partLabel] = choice("component", [], load);
  const [stepSlider, stepSaid, stepLabel] = slider("step", { min: 0, max: view.steps.length - 1, value: view.steps.length - 1 }, load);
  const [amountSlider, amountSaid, amountLabel] = slider("displacement times", { min: 0, max: 100, value: 25 }, draw);
  const mesh = element("input", { type: "checkbox" });
  mesh.checked = edges.length < 60000;
  mesh.addEventListener("change", draw);
  holder.append(element("div", { class: "controls" }, fieldLabel, partLabel, stepLabel, amountLabel, element("label", {}, mesh, " edges")), canvas,
    element("div", { class: "controls" }, bar, limits));
  let shown = [0, 1];

  // 25 is once, 0 is not at all, 100 is a thousand times.
  const amount = () => (amountSlider.value <= 25 ? amountSlider.value / 25 : 10 ** ((amountSlider.value - 25) / 25));

  function components() {
    const [, count] = last.fields.find(([name]) => name === fieldList.value) || ["", 1];
    const options = count === 1 ? [["0", "value"]] : [...(count === 3 ? [["size", "size"]] : []), ...Array.from({ length: count }, (_, at) => [String(at), count === 3 ? "xyz"[at] : String(at + 1)])];
    partList.replaceChildren(...options.map(([value, words]) => element("option", { value }, words)));
  }

  function load() {
    const step = view.steps[stepSlider.value];
    const values = valuesOf(step, fieldList.value, partList.value) || new Float32Array(points.length / 3);
    attribute("displacement", 3, new Float32Array(bytes(step.displacement)));
    attribute("value", 1, values);
    shown = limitsOf(values);
    limits.textContent = `${number(shown[0])} to ${number(shown[1])}`;
    stepSaid.textContent = step.time === null ? `${Number(stepSlider.value) + 1} of ${view.steps.length}` : `time ${number(step.time)}`;
    draw();
  }

  function draw() {
    amountSaid.textContent = number(+amount().toPrecision(3));
    const scale = devicePixelRatio || 1;
    canvas.width = (canvas.clientWidth || 1000) * scale;
    canvas.height = (canvas.clientHeight || 560) * scale;
    const [a, b] = state.angles, [ca, sa, cb, sb] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...BACKGROUND.map((part) => part / 255), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.uniformMatrix3fv(uniform("turn"), false, [ca, sb * sa, -cb * sa, 0, cb, sb, sa, -sb * ca, cb * ca]);
    gl.uniform3fv(uniform("centre"), centre);
    gl.uniform2fv(uniform("shift"), state.shift);
    const wide = canvas.width / canvas.height;
    gl.uniform2fv(uniform("aspect"), wide > 1 ? [1 / wide, 1] : [1, wide]);
    gl.uniform1f(uniform("zoom"), state.zoom);
    gl.uniform1f(uniform("amount"), amount());
    gl.uniform2fv(uniform("limits"), shown[1] > shown[0] ? shown : [shown[0] - 1, shown[0] + 1]);
    gl.uniform1f(uniform("plain"), 0);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1, 1);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, faces);
    gl.drawElements(gl.TRIANGLES, triangles.length, gl.UNSIGNED_INT, 0);
    if (mesh.checked) {
      gl.uniform1f(uniform("plain"), 1);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, wires);
      gl.drawElements(gl.LINES, edges.length, gl.UNSIGNED_INT, 0);
    }
  }

  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener("pointermove", (event) => {
    if (!event.buttons) return;
    if (event.shiftKey || event.buttons === 2) {
      const unit = Math.min(canvas.clientWidth, canvas.clientHeight) / 2;
      state.shift = [state.shift[0] + event.movementX / unit, state.shift[1] - event.movementY / unit];
    } else {
      state.angles = [state.angles[0] + event.movementX / 150, state.angles[1] + event.movementY / 150];
    }
    draw();
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    const factor = Math.exp(-event.deltaY / 600);
    state.zoom *= factor;
    state.shift = state.shift.map((part) => part * factor);
    draw();
  }, { passive: false });
  addEventListener("resize", draw);
  components();
  load();
  root.dataset.drawn = Number(root.dataset.drawn || 0) + coloured(gl);
}

// How many points of the canvas are not background; the page tells it for tests.
function coloured(gl) {
  const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight], all = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, all);
  let count = 0;
  for (let at = 0; at < all.length; at += 4) count += BACKGROUND.some((part, own) => Math.abs(all[at + own] - part) > 8);
  return count;
}

for (const view of views) show(view);
for (const words of missing) section("Mesh", element("pre", {}, words));
root.dataset.ready = String(document.querySelectorAll("svg").length);
