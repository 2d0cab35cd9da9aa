// The section of tetrahedra with a plane: triangles with linearly interpolated points, displacements and values.
function sectionOf(tetrahedra, ranges, plane, points, displacement, values) {
  const [a, b, c, d] = plane, found = { point: [], displacement: [], value: [] };
  const side = (at) => a * points[3 * at] + b * points[3 * at + 1] + c * points[3 * at + 2] - d;
  const corner = (p, q, hp, hq) => {
    const t = hp / (hp - hq), mix = (all, at) => all[at(p)] + t * (all[at(q)] - all[at(p)]);
    for (let axis = 0; axis < 3; axis += 1) {
      found.point.push(mix(points, (at) => 3 * at + axis));
      found.displacement.push(mix(displacement, (at) => 3 * at + axis));
    }
    const value = mix(values, (at) => at);
    found.value.push(Number.isFinite(value) ? value : NO_VALUE);
  };
  for (const [from, count] of ranges) {
    for (let at = from; at < from + count; at += 4) {
      const nodes = tetrahedra.subarray(at, at + 4), heights = [side(nodes[0]), side(nodes[1]), side(nodes[2]), side(nodes[3])];
      const above = [], below = [];
      for (let k = 0; k < 4; k += 1) (heights[k] > 0 ? above : below).push(k);
      if (!above.length || !below.length) continue;
      const push = (p, q) => corner(nodes[p], nodes[q], heights[p], heights[q]);
      if (above.length === 2) {
        const [p, q] = above, [r, s] = below;
        push(p, r); push(p, s); push(q, s);
        push(p, r); push(q, s); push(q, r);
      } else {
        const [single, others] = above.length === 1 ? [above[0], below] : [below[0], above];
        for (const other of others) push(single, other);
      }
    }
  }
  return { point: new Float32Array(found.point), displacement: new Float32Array(found.displacement), value: new Float32Array(found.value) };
}
