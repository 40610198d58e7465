// Geometry of the drawn structure: where a point of a member is, undeformed and deformed.

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Rows of numbers at even stations, linear between them, at t from 0 to 1. */
function between(rows, t) {
  const at = t * (rows.length - 1), k = Math.min(Math.floor(at), rows.length - 2);
  return rows[k].map((value, i) => value + (at - k) * (rows[k + 1][i] - value));
}

/** Movement of a member's end: the node's, carried over the rigid arm. */
function endMovement(movement, arm) {
  if (!movement) return { shift: [0, 0, 0], turn: [0, 0, 0] };
  const turn = movement.slice(3, 6);
  return { shift: add(movement.slice(0, 3), cross(turn, arm)), turn };
}

/**
 * Points along a member at `segments + 1` even stations. With `bow`, rows of its deflections [y, z] from the chord at even
 * stations, they are as the analysis has them, loads, shear and releases included; without (modes, buckling shapes), cubic
 * between its ends.
 */
export function memberLine(member, nodes, movements, scale, segments, bow) {
  const [first, second] = member.nodes;
  const start = add(nodes[first], member.offsets[0]);
  const end = add(nodes[second], member.offsets[1]);
  const length = member.length;
  const [x, y, z] = member.axes;
  const a = endMovement(movements && movements[first], member.offsets[0]);
  const b = endMovement(movements && movements[second], member.offsets[1]);
  const points = [];
  for (let k = 0; k <= segments; ++k) {
    const t = k / segments;
    const rest = [start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1]), start[2] + t * (end[2] - start[2])];
    if (!movements || scale === 0) {
      points.push(rest);
      continue;
    }
    const h1 = 1 - 3 * t * t + 2 * t * t * t, h2 = t - 2 * t * t + t * t * t;
    const h3 = 1 - h1, h4 = t * t * t - t * t;
    const along = (1 - t) * dot(a.shift, x) + t * dot(b.shift, x);
    if (bow) {
      const [dy, dz] = between(bow, t);
      const chord = add(scaled(a.shift, 1 - t), scaled(b.shift, t));
      points.push(add(rest, scaled(add(chord, add(scaled(y, dy), scaled(z, dz))), scale)));
      continue;
    }
    const acrossY = h1 * dot(a.shift, y) + h3 * dot(b.shift, y) + length * (h2 * dot(a.turn, z) + h4 * dot(b.turn, z));
    const acrossZ = h1 * dot(a.shift, z) + h3 * dot(b.shift, z) - length * (h2 * dot(a.turn, y) + h4 * dot(b.turn, y));
    points.push(add(rest, scaled(add(add(scaled(x, along), scaled(y, acrossY)), scaled(z, acrossZ)), scale)));
  }
  return points;
}

/** Box around all nodes. */
export function bounds(nodes) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const p of nodes)
    for (let i = 0; i < 3; ++i) {
      low[i] = Math.min(low[i], p[i]);
      high[i] = Math.max(high[i], p[i]);
    }
  const size = Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) || 1;
  return { low, high, centre: [0, 1, 2].map((i) => (low[i] + high[i]) / 2), size };
}
