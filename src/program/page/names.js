// Names of quantities in words and their units, which the program gives, and their components.
function inWords(name) {
  return quantities[name] ? quantities[name][0] : name.toLowerCase().replaceAll("_", " ");
}

function unitOf(name) {
  return quantities[name] ? quantities[name][1] : "";
}

function titleOf(name, component) {
  const unit = unitOf(name), part = component === "size" || component === "value" ? "" : ` ${component}`;
  return `${inWords(name)}${part}${unit ? ` (${unit})` : ""}`;
}

// Components of a field by the names that options have: [value, words].
function componentsOf(name, count) {
  const tensor = /_(STRESS|STRAIN)_VECTOR$/.test(name);
  const axes = tensor ? { 3: ["xx", "yy", "xy"], 4: ["xx", "yy", "zz", "xy"], 6: ["xx", "yy", "zz", "xy", "yz", "xz"] }[count] : count === 3 ? ["x", "y", "z"] : null;
  if (count === 1) return ["value"];
  return [...(count === 3 && !tensor ? ["size"] : []), ...(axes || Array.from({ length: count }, (_, at) => String(at + 1)))];
}

// The values of a field by component, or the sizes of its vectors; null where a step has no such field.
const decoded = new WeakMap();
function valuesOf(step, name, component) {
  const field = step.fields.find(([own]) => own === name);
  if (!field) return null;
  const [, components, text] = field;
  if (!decoded.has(field)) decoded.set(field, new Float32Array(bytes(text ?? step.displacement)));
  const all = decoded.get(field), count = all.length / components;
  if (components === 1) return all;
  const made = new Float32Array(count), names = componentsOf(name, components), shift = names[0] === "size" ? 1 : 0;
  if (component === "size") for (let at = 0; at < count; at += 1) made[at] = Math.hypot(all[3 * at], all[3 * at + 1], all[3 * at + 2]);
  else for (let at = 0, own = names.indexOf(component) - shift; at < count; at += 1) made[at] = all[at * components + own];
  return made;
}

function bytes(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text).buffer;
  const raw = atob(text), made = new Uint8Array(raw.length);
  for (let at = 0; at < raw.length; at += 1) made[at] = raw.charCodeAt(at);
  return made.buffer;
}

function limitsOf(values) {
  let low = Infinity, high = -Infinity;
  for (let at = 0; at < values.length; at += 1) { const value = values[at]; if (value < low) low = value; if (value > high) high = value; }
  return low <= high ? [low, high] : [0, 0];
}
