// The deformed model: coloured by a field, deformed by a factor, cut by a plane, body by body, step by step.
// Largest displacement by the size of the model from which on the true deformation is well seen, and that which a factor aims at.
const [SEEN, AIM] = deformation;
// Angles about the axis upwards, which is z in space and y in the plane, and about the axis to the right.
const VIEWS = { oblique: [0.46, 0.46], "along x": [-Math.PI / 2, 0], "along y": [0, 0], "along z": [0, Math.PI / 2] };
// Words after # in the address of the page, by which it opens as wanted, e.g. #field=CONTACT_PRESSURE&cut=z&at=0.5.
const wanted = new URLSearchParams(location.hash.slice(1));

function labelled(words, control, ...more) {
  return element("label", {}, `${words} `, control, ...more);
}

function select(words, options, act) {
  const list = element("select", {}, ...options.map(([value, said]) => element("option", { value }, said)));
  list.addEventListener("change", act);
  return [list, labelled(words, list)];
}

function button(words, act) {
  const made = element("button", { type: "button" }, words);
  made.addEventListener("click", act);
  return made;
}

function check(words, checked, act) {
  const made = element("input", { type: "checkbox" });
  made.checked = checked;
  made.addEventListener("change", act);
  return [made, element("label", {}, made, ` ${words}`)];
}

// 1, 2 or 5 times a power of ten, at most the value.
function rounded(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((digit) => digit * power).find((own) => own <= value * 1.000001) || power;
}

function nameOf(body, at) {
  const known = (report.bodies || []).find((own) => own.node === body.node);
  return known && known.name ? known.name : `body ${at + 1}`;
}

function show(view, number_) {
  const canvas = element("canvas", { tabindex: 0, role: "img" }), legend = element("div", { class: "legend" });
  const mark = element("div", { class: "most" }, element("span")), told = element("p", { class: "note", role: "status", "aria-live": "polite" });
  const picture = element("div", { class: "picture" }, canvas, legend, mark), controls = element("div", { class: "controls", role: "group", "aria-label": "display of the model" });
  section(number_ ? `Model ${view.name}` : "Model", element("div", { class: "view" }, element("div", {}, picture, told), controls));
  const points = new Float32Array(bytes(view.points)), ids = new Uint32Array(bytes(view.ids)), tetrahedra = new Uint32Array(bytes(view.tetrahedra));
  const paint = painter(canvas, view, points);
  if (!paint) {
    root.dataset.webgl = "none";
    picture.replaceChildren("This browser has no WebGL: the model is not drawn. The tables below have its results.");
    return;
  }
  const { triangles } = paint, count = points.length / 3;
  const box = [0, 1, 2].map((axis) => { let [low, high] = [Infinity, -Infinity]; for (let at = axis; at < points.length; at += 3) { low = Math.min(low, points[at]); high = Math.max(high, points[at]); } return [low, high]; });
  const centre = box.map(([low, high]) => (low + high) / 2), extent = Math.hypot(...box.map(([low, high]) => high - low)) || 1;
  const flat = box[2][1] - box[2][0] < 1e-9 * extent, last = view.steps.length - 1;
  const moves = view.steps.map(() => null);
  const displacementOf = (at) => (moves[at] = moves[at] || new Float32Array(bytes(view.steps[at].displacement)));
  const sizeOf = (all) => { let most = 0; for (let at = 0; at < all.length; at += 3) { const own = Math.hypot(all[at], all[at + 1], all[at + 2]); if (own > most) most = own; } return most; };
  const most = sizeOf(displacementOf(last));
  const automatic = most > 0 && most < SEEN * extent ? rounded((AIM * extent) / most) : 1;
  const state = { angles: flat ? [0, 0] : [...VIEWS.oblique], zoom: 1, shift: [0, 0], values: null, limits: [0, 1], section: null, playing: 0, ready: false };

  const names = view.steps[last].fields.map(([name, components]) => [name, components]);
  const [fieldList, fieldLabel] = select("colour", names.map(([name]) => [name, inWords(name)]), () => { components(); load(); });
  const [partList, partLabel] = select("component", [], load);
  const [rangeList, rangeLabel] = select("range of", [["step", "this step"], ["peaks", "this step without peaks"], ["all", "all steps"]], cut);
  const stepSlider = element("input", { type: "range", min: 0, max: last, value: last, "aria-label": "step" }), stepSaid = element("output");
  stepSlider.addEventListener("input", load);
  const play = button("play", () => (state.playing ? stop() : start()));
  const factor = element("input", { type: "number", step: "any", value: automatic });
  factor.addEventListener("input", draw);
  const scale = (words, value) => { const made = button(words, () => { factor.value = value; draw(); }); return made; };
  const [cutList, cutLabel] = select("cut", [["none", "none"], ["x", "across x"], ["y", "across y"], ["z", "across z"], ["view", "along the line of sight"]], placePlane);
  const cutSlider = element("input", { type: "range", min: 0, max: 1, step: "any", value: 0.5, "aria-label": "place of the cut" }), cutSaid = element("output");
  cutSlider.addEventListener("input", cut);
  const [cutSide, cutSideLabel] = check("other side", false, cut);
  const [edgeBox, edgeLabel] = check("edges of cells", false, draw);
  const bodies = view.bodies.map((body, at) => { const [box_, label] = check(nameOf(body, at), true, () => { cut(); }); return { ...body, box: box_, label }; });
  const several = bodies.length > 1;
  fieldList.value = [wanted.get("field"), ...first_fields].find((name) => names.some(([own]) => own === name)) || (names[0] || [""])[0];

  controls.append(fieldLabel, partLabel, rangeLabel,
    element("div", { class: "row" }, element("span", {}, "step"), stepSlider, stepSaid, ...(last ? [play] : [])),
    element("div", { class: "row" }, labelled("deformation times", factor), scale(`auto (${number(automatic)})`, automatic), scale("true (1)", 1), scale("none (0)", 0)),
    ...(several ? [element("fieldset", {}, element("legend", {}, "bodies"), element("div", { class: "bodies" }, ...bodies.map((body) => body.label)))] : []),
    ...(flat ? [] : [element("div", { class: "row" }, cutLabel, cutSlider, cutSaid, cutSideLabel)]),
    edgeLabel,
    element("div", { class: "row" }, ...(flat ? [] : Object.entries(VIEWS).map(([words, angles]) => button(words, () => { state.angles = [...angles]; fit(); }))), button("fit", () => fit())),
    element("p", { class: "note" }, "Drag or arrow keys rotate, wheel or + and − zoom, Shift moves; a click names the nearest node."));
  if (report.largest && "VON_MISES_STRESS" in report.largest && !names.some(([name]) => name === "VON_MISES_STRESS")) controls.append(element("p", { class: "note" }, "The run has written no stresses at nodes: leave the lists of vtu_output_process empty, or name VON_MISES_STRESS in gauss_point_variables_extrapolated_to_nodes. The table of results has the largest ones."));
  if (view.fields_left_out.length) controls.append(element("p", { class: "note" }, `The model is large: ${view.fields_left_out.map(inWords).join(", ")} are not on this page.`));
  if (view.steps_left_out) controls.append(element("p", { class: "note" }, `${view.steps_left_out} steps are left out of this page.`));
  if (!view.has_edges) { edgeBox.disabled = true; edgeLabel.append(" (too many)"); }
  if (!view.has_inside && bodies.some((body) => body.is_solid)) controls.append(element("p", { class: "note" }, "The model is large: a cut shows the surfaces, and grey instead of the inside."));

  const shownBodies = () => bodies.filter((body) => body.box.checked);
  const amount = () => Number(factor.value) || 0;

  function components() {
    const [, wide] = names.find(([name]) => name === fieldList.value) || ["", 1], options = componentsOf(fieldList.value, wide);
    partList.replaceChildren(...options.map((value) => element("option", { value }, value)));
    if (options.includes(wanted.get("component"))) partList.value = wanted.get("component");
    partLabel.hidden = options.length < 2;
  }

  function load() {
    const step = view.steps[stepSlider.value];
    state.values = valuesOf(step, fieldList.value, partList.value) || new Float32Array(count).fill(NaN);
    paint.fill(displacementOf(Number(stepSlider.value)), state.values);
    stepSaid.textContent = step.time === null ? `${Number(stepSlider.value) + 1} of ${last + 1}` : `time ${number(+step.time.toPrecision(6))}`;
    cut();
  }

  // Points of the bodies that are shown, on the side that the cut leaves.
  function seen() {
    const made = new Uint8Array(count), p = state.plane;
    for (const body of shownBodies()) {
      for (const [list, [from, size]] of [[triangles, body.triangles], [tetrahedra, body.tetrahedra]]) for (let k = from; k < from + size; k += 1) made[list[k]] = 1;
    }
    if (p) for (let at = 0; at < count; at += 1) if (p[0] * points[3 * at] + p[1] * points[3 * at + 1] + p[2] * points[3 * at + 2] > p[3]) made[at] = 0;
    return made;
  }

  // The value that 99 of 100 points do not exceed, zeros aside, and the least one.
  function withoutPeaks(values) {
    const all = values.filter((value) => Number.isFinite(value) && value !== 0).sort();
    return all.length ? [Math.min(0, all[0]) || limitsOf(values)[0], all[Math.floor(0.99 * (all.length - 1))]] : [0, 0];
  }

  // Range of colours over the points that are seen: of the step, or of all that have the field.
  function limits() {
    const own = (values) => values.filter((_, at) => state.seen[at]), here = own(state.values);
    if (rangeList.value === "peaks") return withoutPeaks(here);
    if (rangeList.value === "step") return limitsOf(here);
    const all = view.steps.map((step) => valuesOf(step, fieldList.value, partList.value)).filter(Boolean).map((values) => limitsOf(own(values)));
    return [Math.min(...all.map((both) => both[0])), Math.max(...all.map((both) => both[1]))];
  }

  function turn() {
    const [a, b] = state.angles, [ca, sa, cb, sb] = [Math.cos(a), Math.sin(a), Math.cos(b), Math.sin(b)];
    const [x, y, z] = [[ca, sb * sa, -cb * sa], [0, cb, sb], [sa, -sb * ca, cb * ca]];
    return flat ? [...x, ...y, ...z] : [...x, ...z.map((part) => -part), ...y];
  }

  const sight = () => { const t = turn(); return [t[2], t[5], t[8]]; };

  // The normal of the cut, and its least and largest place.
  function normal() {
    const axis = ["x", "y", "z"].indexOf(cutList.value);
    return axis >= 0 ? [0, 1, 2].map((own) => (own === axis ? 1 : 0)) : state.sight || sight();
  }

  function placePlane() {
    state.sight = sight();
    cut();
  }

  function plane() {
    if (cutList.value === "none") return null;
    const n = normal();
    let low = 0, high = 0;
    box.forEach(([a, b], axis) => { low += Math.min(n[axis] * a, n[axis] * b); high += Math.max(n[axis] * a, n[axis] * b); });
    const at = low + cutSlider.value * (high - low), sign = cutSide.checked ? -1 : 1;
    cutSaid.textContent = number(+at.toPrecision(4));
    return [...n.map((part) => sign * part), sign * at];
  }

  function cut() {
    const own = plane();
    cutSlider.disabled = cutSide.disabled = !own;
    if (!own) cutSaid.textContent = "";
    state.plane = own;
    state.section = own && view.has_inside ? sectionOf(tetrahedra, shownBodies().map((body) => body.tetrahedra), own, points, displacementOf(Number(stepSlider.value)), state.values) : null;
    state.seen = seen();
    state.limits = limits();
    describe();
    draw();
  }

  function largest() {
    let at = -1;
    for (let own = 0; own < count; own += 1) if (state.seen[own] && Number.isFinite(state.values[own]) && !(at >= 0 && state.values[own] <= state.values[at])) at = own;
    return at;
  }

  // Id of a node, where the results have it, and its initial position.
  function nodeAt(at) {
    return `${ids.length ? `node ${ids[at]}` : "the node"} at (${placeInWords([...points.subarray(3 * at, 3 * at + 3)])})`;
  }

  function describe() {
    const title = titleOf(fieldList.value, partList.value), [low, high] = state.limits;
    state.most = high > low ? largest() : -1;
    const place = (value) => `top:${100 - (100 * (value - low)) / (high - low || 1)}%`;
    const marks = high > low ? ticks(low, high).filter((tick) => tick - low > 0.06 * (high - low) && high - tick > 0.06 * (high - low)) : [];
    const ends = high > low ? [low, high] : [low];
    const peak = rangeList.value === "peaks" && state.most >= 0 && state.values[state.most] > high;
    const bar = element("div", { class: "scale", style: `background:linear-gradient(to top,${colours.map((own) => `rgb(${own.join(",")})`).join(",")})` },
      ...[...ends, ...marks].map((tick) => element("span", { style: place(tick) }, `${peak && tick === high ? "≥ " : ""}${number(+tick.toPrecision(4))}`)));
    legend.replaceChildren(element("strong", {}, title), bar, element("div"));
    const where = state.most < 0 ? "" : ` at ${nodeAt(state.most)}`;
    mark.firstChild.textContent = state.most < 0 ? "" : `max ${number(+state.values[state.most].toPrecision(4))}`;
    told.textContent = state.most < 0 ? `${title}: ${number(low)} everywhere` : `Largest ${title} of what is shown: ${number(+state.values[state.most].toPrecision(5))}${where}, ${stepSaid.textContent}.`;
    canvas.setAttribute("aria-label", `Deformed model coloured by ${title}, from ${number(+low.toPrecision(4))} to ${number(+high.toPrecision(4))}. ${told.textContent}`);
  }

  // Place of a point on the canvas, in CSS pixels, and its depth.
  function onCanvas(at) {
    const t = turn(), move = displacementOf(Number(stepSlider.value)), v = [0, 1, 2].map((c) => points[3 * at + c] + amount() * move[3 * at + c] - centre[c]);
    const [x, y, z] = [0, 1, 2].map((row) => t[row] * v[0] + t[3 + row] * v[1] + t[6 + row] * v[2]);
    const [wide, high] = [canvas.clientWidth, canvas.clientHeight], unit = Math.min(wide, high) / 2;
    return [wide / 2 + (x * state.zoom + state.shift[0]) * unit, high / 2 - (y * state.zoom + state.shift[1]) * unit, z];
  }

  function draw() {
    if (!state.ready) return;
    const ratio = devicePixelRatio || 1, moved = extent + amount() * most;
    canvas.width = (canvas.clientWidth || 1000) * ratio;
    canvas.height = (canvas.clientHeight || 560) * ratio;
    const wide = canvas.width / canvas.height, [low, high] = state.limits;
    paint.draw({
      turn: turn(), centre, shift: state.shift, zoom: state.zoom, depth: 0.9 / moved, amount: amount(), plane: state.plane, section: state.section,
      pixel: 2 / (state.zoom * Math.min(canvas.clientWidth, canvas.clientHeight)), aspect: wide > 1 ? [1 / wide, 1] : [1, wide], limits: high > low ? [low, high] : [low - 1, low + 1], bodies: shownBodies(), edges: edgeBox.checked,
    });
    legend.children[2].textContent = amount() === 1 ? "true deformation" : amount() ? `deformation times ${number(amount())}` : "undeformed";
    mark.hidden = state.most < 0;
    if (state.most < 0) return;
    const [x, y] = onCanvas(state.most);
    mark.style.left = `${x}px`;
    mark.style.top = `${y}px`;
    mark.classList.toggle("left", x > canvas.clientWidth - 120);
    mark.hidden = x < 0 || y < 0 || x > canvas.clientWidth || y > canvas.clientHeight;
  }

  // All that is shown in the middle of the canvas, right of the legend.
  function fit() {
    const move = displacementOf(Number(stepSlider.value)), t = turn(), range = [[Infinity, -Infinity], [Infinity, -Infinity]], by = amount();
    for (let at = 0; at < count; at += 1) {
      if (!state.seen[at]) continue;
      const [a, b, c] = [points[3 * at] + by * move[3 * at] - centre[0], points[3 * at + 1] + by * move[3 * at + 1] - centre[1], points[3 * at + 2] + by * move[3 * at + 2] - centre[2]];
      for (let row = 0; row < 2; row += 1) {
        const value = t[row] * a + t[3 + row] * b + t[6 + row] * c, own = range[row];
        if (value < own[0]) own[0] = value;
        if (value > own[1]) own[1] = value;
      }
    }
    const [wide, high] = [canvas.clientWidth || 1000, canvas.clientHeight || 560], unit = Math.min(wide, high) / 2, aside = getComputedStyle(legend).position === "absolute" ? legend.offsetWidth + 12 : 0, free = 1 - aside / wide;
    if (range[0][0] > range[0][1]) return;
    const sizes = range.map(([a, b]) => Math.max(b - a, 1e-9 * extent));
    state.zoom = 0.92 * Math.min((2 * free * wide) / 2 / unit / sizes[0], (2 * high) / 2 / unit / sizes[1]);
    state.shift = [(wide * (1 - free)) / 2 / unit - (state.zoom * (range[0][0] + range[0][1])) / 2, (-state.zoom * (range[1][0] + range[1][1])) / 2];
    draw();
  }

  function start() {
    if (Number(stepSlider.value) === last) stepSlider.value = -1;
    play.textContent = "stop";
    rangeList.value = "all";
    state.playing = setInterval(() => {
      if (Number(stepSlider.value) === last) { stop(); return; }
      stepSlider.value = Number(stepSlider.value) + 1;
      load();
    }, Math.max(60, Math.min(500, 6000 / (last + 1))));
    load();
  }

  function stop() {
    clearInterval(state.playing);
    state.playing = 0;
    play.textContent = "play";
  }

  function zoom(by) {
    state.zoom *= by;
    state.shift = state.shift.map((part) => part * by);
    draw();
  }

  function move(x, y, shifts) {
    const unit = Math.min(canvas.clientWidth, canvas.clientHeight) / 2;
    if (shifts) state.shift = [state.shift[0] + x / unit, state.shift[1] - y / unit];
    else state.angles = [state.angles[0] + x / 150, state.angles[1] + y / 150];
    draw();
  }

  // Tells the values of the node in front that is nearest to a place of the canvas.
  function pick(x, y) {
    let found = -1, best = Infinity, front = -Infinity;
    for (let at = 0; at < count; at += 1) {
      if (!state.seen[at]) continue;
      const [px, py, pz] = onCanvas(at), far = Math.hypot(px - x, py - y);
      if (far < 15 && (pz > front + 1e-6 * extent || (Math.abs(pz - front) <= 1e-6 * extent && far < best))) { found = at; best = far; front = pz; }
    }
    if (found >= 0) told.textContent = `At ${nodeAt(found)}: ${titleOf(fieldList.value, partList.value)} ${number(+state.values[found].toPrecision(5))}.`;
  }

  let travelled = 0;
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());
  canvas.addEventListener("pointerdown", (event) => { travelled = 0; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", (event) => {
    if (!event.buttons) return;
    travelled += Math.abs(event.movementX) + Math.abs(event.movementY);
    move(event.movementX, event.movementY, event.shiftKey || event.buttons === 2);
  });
  canvas.addEventListener("pointerup", (event) => { if (travelled < 4) pick(event.offsetX, event.offsetY); });
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); zoom(Math.exp(-event.deltaY / 600)); }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
    if (way) move(12 * way[0], 12 * way[1], event.shiftKey);
    else if (event.key === "+" || event.key === "=") zoom(1.15);
    else if (event.key === "-") zoom(1 / 1.15);
    else if (event.key === "0" || event.key === "Home") fit();
    else return;
    event.preventDefault();
  });
  addEventListener("resize", fit);

  const set = (control, key) => { if (wanted.has(key)) control.value = wanted.get(key); };
  [[rangeList, "range"], [stepSlider, "step"], [factor, "factor"], [cutList, "cut"], [cutSlider, "at"]].forEach(([control, key]) => set(control, key));
  for (const hidden of wanted.getAll("hide")) bodies.filter((body, at) => nameOf(body, at) === hidden).forEach((body) => { body.box.checked = false; });
  if (wanted.has("turn")) state.angles = wanted.get("turn").split(",").map(Number);
  if (wanted.has("side")) cutSide.checked = true;
  components();
  load();
  const [top, peaks] = [limits()[1], withoutPeaks(state.values.filter((_, at) => state.seen[at]))[1]];
  if (rangeList.value === "step" && peaks < 0.5 * top) { rangeList.value = "peaks"; cut(); }
  // Edges show where cells are larger than a few pixels.
  edgeBox.checked = view.has_edges && (canvas.clientWidth * canvas.clientHeight) / Math.max(1, triangles.length / 3) > 40;
  state.ready = true;
  fit();
  root.dataset.drawn = Number(root.dataset.drawn || 0) + paint.coloured();
  root.dataset.most = state.most < 0 ? "" : `${fieldList.value} ${state.values[state.most].toPrecision(6)} ${ids[state.most] ?? ""}`;
}

views.forEach(show);
for (const words of missing) section("Model", element("pre", {}, words));
