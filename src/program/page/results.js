// The results that an engineer asks for first: extremes with their places, reactions by support, forces of pairs and their balance.
const steps = report.steps, accepted = steps.filter((step) => step.converged), iterations = steps.flatMap((step) => step.iterations);
const size = (vector) => Math.hypot(...vector);
const balanced = accepted.filter((step) => step.balance);
const short = (value) => (typeof value === "number" && Number.isFinite(value) ? number(+value.toPrecision(5)) : value);
const problems = [...(report.errors || []), ...(report.warnings || [])];
const plural = (count, word) => `${count} ${word}${count === 1 ? "" : "s"}`;

{
  const status = document.getElementById("status"), errors = (report.errors || []).length, warnings = (report.warnings || []).length;
  const failed = report.exit_code === 0 ? "" : ` Exit code ${report.exit_code}.`;
  status.append(`${plural(report.converged_steps ?? accepted.length, "step")} converged in ${plural(report.iterations ?? iterations.length, "iteration")}.${failed} `);
  if (errors + warnings) status.append(element("a", { href: "#problems", ...(errors ? { class: "bad" } : {}) }, [errors ? plural(errors, "error") : "", warnings ? plural(warnings, "warning") : ""].filter(Boolean).join(", ")), ".");
  if (report.exit_code) status.classList.add("bad");
}

{
  // The first of these a reader looks for; others follow by name.
  const order = ["DISPLACEMENT", "VON_MISES_STRESS", "MAX_PRINCIPAL_STRESS", "MIN_PRINCIPAL_STRESS", "TRESCA_STRESS", "HYDROSTATIC_PRESSURE", "SAFETY_FACTOR", "CONTACT_PRESSURE", "TEMPERATURE"];
  const places = report.places || {};
  const rows = [["largest", report.largest], ["smallest", report.smallest]].flatMap(([kind, all]) => Object.entries(all || {}).filter(([name]) => name !== "CONTACT_STATUS").map(([name, value]) => {
    const { node, position } = places[name] || {};
    const said = /^(largest|smallest) /.test(inWords(name)) ? inWords(name) : `${kind} ${inWords(name)}`;
    return { name, cells: [said, short(value), unitOf(name), node ?? "", position ? placeInWords(position) : ""] };
  }));
  const rank = ({ name }) => (order.includes(name) ? order.indexOf(name) : order.length);
  rows.sort((a, b) => rank(a) - rank(b));
  const made = section("Results", ...(rows.length ? [table(["result", "value", "unit", "node", "initial position"], rows.map((row) => row.cells), "At the end of the run, at nodes; stresses are means of the Gauss points around a node. Of vectors the size.")]
    : [element("p", {}, "The run has left no results: it did not come to its end, or an earlier version of the program has written its report.")]));
  made.id = "results";
}

if (balanced.length) {
  const last = balanced[balanced.length - 1], { supports = [], pairs: all = [], unknowns } = last.balance, when = ` at time ${number(+last.time.toPrecision(6))}`;
  const vector = (own) => own.map(short);
  for (const sums of unknowns) {
    const own = supports.filter((support) => support.unknown === sums.unknown), flows = !sums.moments, heads = flows ? ["sum"] : ["x", "y", "z"];
    const cut_ = (values) => (flows ? [values[0]] : values), moments = flows ? [] : ["moment x", "moment y", "moment z"];
    const rows = own.map((support) => [support.part.split(".").slice(1).join(".") || support.part, ...vector(cut_(support.reaction)), ...(flows ? [] : vector(support.moment))]);
    const total = (words, forces, turned) => [element("strong", {}, words), ...vector(cut_(forces)), ...(flows ? [] : turned ? vector(turned) : ["", "", ""])];
    rows.push(total("all supports", sums.forces.reactions, (sums.moments || {}).reactions), total("loads", sums.forces.loads, (sums.moments || {}).loads), total("out of balance", sums.forces.out_of_balance, (sums.moments || {}).out_of_balance));
    const about = flows ? "" : ` Moments about (${placeInWords(sums.centre)}).`;
    section(`Reactions${sums.unknown === "DISPLACEMENT" ? "" : ` of ${inWords(sums.unknown)}`} by support`,
      table(["support", ...heads, ...moments], rows, `Sums over the unknowns that processes fix${when}.${about} The remainder is ${number(sums.forces.relative)} of the largest sum.`));
  }
  if (all.length) section("Forces of contact pairs and ties", table(["pair", "x", "y", "z", "size", "both sides", "open", "stick", "slip", "penetration"],
    all.map((pair) => [pair.name, ...vector(pair.force), short(size(pair.force)), short(size(pair.out_of_balance)), pair.open, pair.sticking, pair.slipping, short(pair.penetration)]),
    `Forces on the slave side${when}; the sum over both sides is the remainder; numbers of slave nodes by state; largest penetration (length).`));
}

section(`Errors and warnings (${problems.length})`, ...(problems.length ? problems.map((words) => element("pre", words.startsWith("warning") ? {} : { class: "bad" }, words)) : [element("p", {}, "none")])).id = "problems";
