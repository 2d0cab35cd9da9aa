// Elements of the page: tables, and lines over a common axis.
const COLOURS = ["#2563a8", "#c2410c", "#15803d", "#7e22ce", "#b45309", "#0e7490", "#be185d", "#4d5562"];

function element(name, attributes, ...children) {
  const made = name === "svg" || element.within ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

function section(title, ...children) {
  section.count = (section.count || 0) + 1;
  const made = element("section", { "aria-labelledby": `section-${section.count}` }, element("h2", { id: `section-${section.count}` }, title), ...children);
  document.getElementById("sections").append(made);
  return made;
}

function number(value) {
  if (value === null || value === undefined) return "";
  if (typeof value !== "number") return String(value);
  const size = Math.abs(value);
  return Number.isInteger(value) && size < 1e9 ? String(value) : size >= 1e-3 && size < 1e6 ? String(+value.toPrecision(6)) : value.toExponential(3);
}

// A place, round-off beside its largest coordinate as 0.
function placeInWords(position) {
  const most = Math.max(...position.map(Math.abs));
  return position.map((x) => number(Math.abs(x) < 1e-9 * most ? 0 : +x.toPrecision(5))).map(String).join(", ");
}

function table(heads, rows, caption) {
  const cellOf = (cell, kind, scope) => element(kind, scope ? { scope } : {}, cell instanceof Node ? cell : number(cell));
  const row = ([first, ...others]) => element("tr", {}, cellOf(first, "th", "row"), ...others.map((cell) => cellOf(cell, "td")));
  const made = element("table", caption ? { "aria-label": caption } : {}, element("thead", {}, element("tr", {}, ...heads.map((head) => cellOf(head, "th", "col")))), element("tbody", {}, ...rows.map(row)));
  // A table that scrolls is reached by the keyboard.
  const scrolled = element("div", { class: "scroll", tabindex: 0, role: "region", "aria-label": caption || heads.join(", ") }, made);
  return caption ? element("div", {}, element("p", { class: "note" }, caption), scrolled) : scrolled;
}

// Round numbers between two limits.
function ticks(low, high) {
  const raw = (high - low) / 5 || 1, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((width) => width >= raw);
  const found = [];
  for (let at = Math.ceil(low / step) * step; at <= high + 1e-9 * step; at += step) found.push(Math.abs(at) < 1e-12 * step ? 0 : at);
  return found;
}

// Lines: [{name, points: [[x, y], ...]}]; `log` for decades upwards; `marks` are lines from bottom to top.
function chart(lines, { x, y, log = false, marks = [] }) {
  const usable = lines.map((line) => ({ ...line, points: line.points.filter(([a, b]) => Number.isFinite(a) && Number.isFinite(b) && (!log || b > 0)) }));
  const all = usable.flatMap((line) => line.points);
  if (!all.length) return element("p", {}, "nothing to show");
  const up = (value) => (log ? Math.log10(value) : value);
  const range = (values) => {
    let low = Infinity, high = -Infinity;
    for (const value of values) { low = Math.min(low, value); high = Math.max(high, value); }
    return high - low > 1e-6 * Math.max(Math.abs(low), Math.abs(high)) ? [low, high] : [low - 0.5 * (Math.abs(low) || 1), high + 0.5 * (Math.abs(high) || 1)];
  };
  let [left, right] = range(all.map((point) => point[0])), [bottom, top] = range(all.map((point) => up(point[1])));
  if (log) { bottom = Math.floor(bottom); top = Math.ceil(top); }
  const [width, height, edge, foot, head] = [1000, 290, 90, 40, 44];
  const px = (value) => edge + ((value - left) / (right - left)) * (width - edge - 10);
  const py = (value) => height - foot - ((value - bottom) / (top - bottom)) * (height - foot - head);
  element.within = true;
  const parts = [];
  const text = (at, to, words, anchor) => element("text", { x: at, y: to, "text-anchor": anchor }, words);
  for (const tick of ticks(left, right)) parts.push(text(px(tick), height - foot + 16, number(+tick.toPrecision(12)), "middle"));
  for (const tick of ticks(bottom, top)) {
    if (log && !Number.isInteger(tick)) continue;
    parts.push(element("line", { x1: edge, x2: width - 10, y1: py(tick), y2: py(tick), stroke: "#e3e7ed" }));
    parts.push(text(edge - 6, py(tick) + 4, log ? `1e${tick}` : number(+tick.toPrecision(12)), "end"));
  }
  for (const mark of marks) parts.push(element("line", { x1: px(mark), x2: px(mark), y1: head, y2: height - foot, stroke: "#d4dae2", "stroke-dasharray": "3 3" }));
  let next = edge;
  usable.forEach((line, at) => {
    const colour = COLOURS[at % COLOURS.length];
    let run = [];
    const runs = [run];
    line.points.forEach((point) => { if (point[2]) runs.push(run = []); run.push(point); });
    for (const points of runs) parts.push(element("polyline", { points: points.map(([a, b]) => `${px(a)},${py(up(b))}`).join(" "), fill: "none", stroke: colour, "stroke-width": 1.8 }));
    if (line.points.length < 80) for (const [a, b] of line.points) parts.push(element("circle", { cx: px(a), cy: py(up(b)), r: 2.4, fill: colour }));
    parts.push(element("rect", { x: next, y: 22, width: 12, height: 12, fill: colour }), text(next + 17, 33, line.name, "start"));
    next += 40 + 7 * line.name.length;
  });
  parts.push(text((edge + width) / 2, height - 4, x, "middle"), text(4, 12, y, "start"));
  const made = element("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": `${y} over ${x}: ${usable.map((line) => line.name).join(", ")}` }, ...parts);
  element.within = false;
  return made;
}
