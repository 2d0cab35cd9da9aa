// What a report says of the course of the run, section by section.
const overTime = (name, of) => ({ name, points: balanced.map((step) => [step.time, of(step.balance)]) });

const pairs = new Map();
for (const step of balanced) for (const pair of step.balance.pairs) (pairs.has(pair.name) ? pairs : pairs.set(pair.name, [])).get(pair.name).push([step.time, pair]);
for (const [name, states] of pairs) {
  const line = (label, of) => ({ name: label, points: states.map(([time, pair]) => [time, of(pair)]) });
  section(`Contact ${name} over time`,
    chart([line("open", (pair) => pair.open), line("sticking", (pair) => pair.sticking), line("slipping", (pair) => pair.slipping)], { x: "time", y: "slave nodes" }),
    chart([line("force", (pair) => size(pair.force))], { x: "time", y: "size of the contact force" }),
    chart([line("penetration", (pair) => pair.penetration)], { x: "time", y: "largest penetration" }));
}

if (balanced.length) {
  const last = balanced[balanced.length - 1];
  for (const [at, { unknown }] of last.balance.unknowns.entries()) {
    const line = (name, of) => overTime(name, (balance) => balance.unknowns[at] && of(balance.unknowns[at].forces));
    const rows = ["loads", "reactions", "elements", "interactions", "inertia", "out_of_balance"].map((key) => [key.replaceAll("_", " "), ...last.balance.unknowns[at].forces[key]]);
    const flows = last.balance.unknowns[at].flows;
    if (flows) rows.push(...["entering", "leaving", "stored"].map((key) => [key, flows[key]]));
    section(`Balance of ${unknown} over time`,
      chart([line("loads", (sums) => size(sums.loads)), line("reactions", (sums) => size(sums.reactions)), line("inertia", (sums) => size(sums.inertia))], { x: "time", y: "size of the sum" }),
      chart([line("out of balance", (sums) => sums.relative)], { x: "time", y: "by the largest sum", log: true }),
      element("p", {}, `at time ${number(last.time)}:`), table(["sum", "x", "y", "z"], rows));
  }
  const kinds = Object.keys(last.balance.energies);
  section("Energies", chart(kinds.map((kind) => overTime(kind, (balance) => balance.energies[kind])), { x: "time", y: "energy or work since the stage began" }));
}

const numbers = new Map();
for (const step of accepted) for (const [name, value] of step.interactions) (numbers.has(name) ? numbers : numbers.set(name, [])).get(name).push([step.time, value]);
for (const [name, points] of numbers) if (!pairs.size || name === "pairs") section(name, chart([{ name, points }], { x: "time", y: name }));

{
  const lines = new Map(), marks = [];
  let at = 0;
  for (const step of steps) {
    if (at) marks.push(at + 0.5);
    step.iterations.forEach((iteration, first) => {
      at += 1;
      for (const check of iteration.checks) {
        if (!lines.has(check.label)) lines.set(check.label, { name: check.label, points: [] });
        lines.get(check.label).points.push([at, check.ratio, first === 0]);
      }
    });
  }
  const said = steps.map((step) => [step.step, step.time, step.delta_time, step.iterations.length, step.converged ? "yes" : element("span", { class: "bad" }, step.failure || "no"), step.iterations.reduce((sum, own) => sum + own.linear_iterations, 0)]);
  section("Convergence", chart([...lines.values()], { x: "iteration; steps are parted by dashes", y: "ratio", log: true, marks: marks.length < 120 ? marks : [] }),
    table(["step", "time", "length", "iterations", "converged", "linear iterations"], said));
}

if ((report.notes || []).length) section("Notes", ...report.notes.map((words) => element("pre", {}, words)));

{
  const phases = Object.entries(report.seconds || {}).filter(([name]) => name !== "total").sort((a, b) => b[1] - a[1]);
  const most = phases.length ? phases[0][1] : 1;
  const bar = (seconds) => element("div", { style: `width:${Math.round((300 * seconds) / most)}px;height:10px;background:${COLOURS[0]};margin-top:6px` });
  section("Where the time went", table(["phase", "seconds", ""], phases.map(([name, seconds]) => [name, +seconds.toFixed(3), bar(seconds)])));
}

section("Run", table(["fact", "value"], [
  ["version", report.version], ["defaults of", report.like || "zelus"],
  ["nodes, elements, conditions", [report.sizes.nodes, report.sizes.elements, report.sizes.conditions].join(", ")],
  ["unknowns", report.sizes.unknowns], ["threads", report.threads], ["seconds", (report.seconds || {}).total],
  ["largest memory", report.memory ? `${(report.memory / 1e6).toFixed(1)} MB` : "unknown"],
  ["steps that converged", accepted.length], ["attempts that failed", steps.length - accepted.length], ["iterations", iterations.length],
  ["exit code", report.exit_code], ["linear solver", report.linear_solver], ...Object.entries(report.parameters || {}),
]));

// Elements that reach beyond the window, for tests; scrolled ones stay within their holder.
function overflowing() {
  const wide = document.documentElement.clientWidth + 1, isScrolled = (own) => own.parentElement && own.parentElement.closest(".scroll, .picture, .bodies");
  return [...document.body.querySelectorAll("*")].filter((own) => !isScrolled(own) && !own.classList.contains("skip") && own.getBoundingClientRect().right > wide).length;
}

root.dataset.overflow = String(document.documentElement.scrollWidth > document.documentElement.clientWidth ? 1 + overflowing() : overflowing());
root.dataset.ready = String(document.querySelectorAll("svg").length);
