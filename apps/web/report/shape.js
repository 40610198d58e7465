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

/** Motions of the inner nodes of members that the modes divide ("M/cut-1" ... of a shape), in lists by the member's name. */
export function innerMotions(shape, isNode) {
  const inner = new Map();
  for (const [name, motion] of Object.entries(shape ?? {})) {
    const [, member, number] = isNode(name) ? [] : name.match(/^(.*)\/cut-(\d+)$/) ?? [];
    if (!member) continue;
    if (!inner.has(member)) inner.set(member, []);
    inner.get(member)[Number(number) - 1] = motion;
  }
  return inner;
}

/** A divided member's points: those of its pieces, each cubic between its own ends. */
function dividedLine(member, nodes, movements, inner, scale, segments) {
  const [first, second] = member.nodes;
  const ends = [add(nodes[first], member.offsets[0]), add(nodes[second], member.offsets[1])];
  const pieces = inner.length + 1, none = [0, 0, 0];
  const at = (i) => add(ends[0], scaled(add(ends[1], scaled(ends[0], -1)), i / pieces));
  const points = [];
  for (let i = 0; i < pieces; ++i) {
    const last = i + 1 === pieces;
    const piece = {
      ...member, nodes: [0, 1], length: member.length / pieces,
      offsets: [i === 0 ? member.offsets[0] : none, last ? member.offsets[1] : none],
    };
    const line = memberLine(piece, [i === 0 ? nodes[first] : at(i), last ? nodes[second] : at(i + 1)],
      [i === 0 ? movements[first] : inner[i - 1], last ? movements[second] : inner[i]], scale, 8, null);
    points.push(...line.slice(i === 0 ? 0 : 1));
  }
  // The stations that were asked for, out of eight to a piece.
  return Array.from({ length: segments + 1 }, (_, k) => {
    const place = (k / segments) * (points.length - 1), before = Math.min(Math.floor(place), points.length - 2);
    return add(points[before], scaled(add(points[before + 1], scaled(points[before], -1)), place - before));
  });
}

/**
 * Points along a member at `segments + 1` even stations. With `bow`, rows of its deflections [y, z] from the chord at even
 * stations, they are as the analysis has them, loads, shear and releases included; without (modes, buckling shapes), cubic
 * between its ends and the nodes of `movements.inner` (innerMotions).
 */
export function memberLine(member, nodes, movements, scale, segments, bow) {
  const inner = !bow && scale !== 0 ? movements?.inner?.get(member.name) : undefined;
  if (inner) return dividedLine(member, nodes, movements, inner, scale, segments);
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
