// Line drawings for paper, as SVG: the model in plan, elevations and a view from the south-east, loads on it, its deformed
// shape, and diagrams along single members. Every drawing keeps the proportions of what it shows.
import { bounds, memberLine } from './shape.js';
import { number } from './format.js';

const NS = 'http://www.w3.org/2000/svg';
const INK = { post: '#1d2733', beam: '#3f6fa8', brace: '#8a5a1f' };

function element(name, attributes, parent) {
  const made = document.createElementNS(NS, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  parent?.append(made);
  return made;
}

/** Directions on paper (right, up) of the ways to look. */
export const LOOKS = {
  plan: { title: 'Plan (from above)', right: [1, 0, 0], up: [0, 1, 0] },
  south: { title: 'Elevation from the south (x, z)', right: [1, 0, 0], up: [0, 0, 1] },
  east: { title: 'Elevation from the east (y, z)', right: [0, 1, 0], up: [0, 0, 1] },
  view: { title: 'View from the south-east', right: [0.8, 0.6, 0], up: [-0.225, 0.3, 0.927] },
};

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** What is seen of the model: [low, high] on paper in the model's lengths, to the right and down. */
function extent(model, on) {
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (const p of model.nodes) {
    const q = on(p);
    for (let i = 0; i < 2; ++i) {
      low[i] = Math.min(low[i], q[i]);
      high[i] = Math.max(high[i], q[i]);
    }
  }
  return { low, wide: Math.max(high[0] - low[0], 1e-9), tall: Math.max(high[1] - low[1], 1e-9) };
}

/** A drawing of the model: {svg, at(point) on paper, scale, narrow, names}. That of a tower is `narrow`: half as wide, and high. */
function sheet(model, look, height = 360, margin = 30) {
  const on = (p) => [dot(p, look.right), -dot(p, look.up)];
  const { low, wide, tall } = extent(model, on);
  const narrow = tall > 1.2 * wide;
  const width = narrow ? 330 : 680, most = narrow ? 1.7 * height : height;
  const scale = Math.min((width - 2 * margin) / wide, (most - 2 * margin) / tall);
  const paper = Math.min(most, tall * scale + 2 * margin);
  const shift = [(width - wide * scale) / 2 - low[0] * scale, margin - low[1] * scale];
  const svg = element('svg', { viewBox: `0 0 ${width} ${paper.toFixed(1)}`, class: 'drawing' });
  const at = (p) => on(p).map((v, i) => v * scale + shift[i]);
  return { svg, at, scale, narrow, names: new Names(svg, width, paper) };
}

/** Texts at points of a drawing that cover neither each other nor its border: one that finds no place is left out. */
class Names {
  constructor(svg, width, height) {
    Object.assign(this, { svg, width, height, boxes: [], left: 0 });
  }

  /** At `point`, beside or above it; true where there was a place. */
  put([x, y], text, name = 'name', size = 9) {
    const long = 0.58 * size * text.length;
    for (const away of [3, 9, 16])
      for (const [left, top] of [[x + away, y - away - size], [x + away, y + away], [x - away - long, y - away - size], [x - away - long, y + away], [x - long / 2, y - away - 1.2 * size], [x - long / 2, y + away]])
        if (this.#free([left, top, left + long, top + size])) {
          this.write(left, top + 0.8 * size, text, 'start', name);
          return true;
        }
    ++this.left;
    return false;
  }

  /** A text at a place of its own, centred, if it covers no other. */
  centred(x, baseline, text, name = 'name', size = 9) {
    const half = 0.29 * size * text.length;
    if (!this.#free([x - half, baseline - 0.8 * size, x + half, baseline + 0.2 * size])) return false;
    this.write(x, baseline, text, 'middle', name);
    return true;
  }

  write(x, y, text, anchor, name) {
    element('text', { x: x.toFixed(1), y: y.toFixed(1), 'text-anchor': anchor, class: name }, this.svg).textContent = text;
  }

  #free(box) {
    const apart = ([l, t, r, b]) => box[0] > r + 4 || box[2] < l - 4 || box[1] > b || box[3] < t;
    if (box[0] < 2 || box[1] < 2 || box[2] > this.width - 2 || box[3] > this.height - 2 || !this.boxes.every(apart)) return false;
    this.boxes.push(box);
    return true;
  }
}

const path = (points) => points.map(([x, y], k) => `${k ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`).join('');

/** Members as one path for each kind, so that ten thousands of them stay few elements. */
function drawMembers(drawing, model, line, colour = null, width = 0.8) {
  for (const kind of ['post', 'beam', 'brace']) {
    const parts = model.members.filter((m) => m.kind === kind).map((m) => path(line(m).map(drawing.at)));
    if (parts.length) element('path', { d: parts.join(''), fill: 'none', stroke: colour ?? INK[kind], 'stroke-width': width }, drawing.svg);
  }
}

/** Members that a large building's report does not hold, as one thin path. */
function drawRest(drawing, model) {
  const rest = model.lines ?? [];
  const parts = [];
  for (let k = 0; k + 1 < rest.length; k += 2) parts.push(path([model.nodes[rest[k]], model.nodes[rest[k + 1]]].map(drawing.at)));
  if (parts.length) element('path', { d: parts.join(''), fill: 'none', stroke: '#b9c3cd', 'stroke-width': 0.15 }, drawing.svg);
}

const straight = (model) => (m) => m.nodes.map((n, end) => model.nodes[n].map((v, i) => v + m.offsets[end][i]));

function drawSupports(drawing, model) {
  const marks = [...new Set(model.supports)].map((n) => {
    const [x, y] = drawing.at(model.nodes[n]);
    return `M${x.toFixed(1)} ${y.toFixed(1)}l-4 6h8z`;
  });
  element('path', { d: marks.join(''), fill: '#5b6875' }, drawing.svg);
}

/** Where posts stand along a direction (without posts: the supports), each place once. */
function lines(model, d, size) {
  const ends = model.members.filter((m) => m.kind === 'post').flatMap((m) => m.nodes);
  const all = (ends.length ? ends : model.supports).map((n) => dot(model.nodes[n], d)).sort((a, b) => a - b);
  return all.filter((v, k) => k === 0 || v - all[k - 1] > 1e-4 * size);
}

/** Coordinates of the lines of posts and of the storeys along the drawing's two ways, and its whole size; of those that lie close not all. */
function drawLines(drawing, model, look, unit) {
  if (look === LOOKS.view) return;  // a slanted view has no true lengths
  const { width, height } = drawing.names;
  const size = bounds(model.nodes).size, bare = (v) => String(Number(v.toPrecision(4)));
  const box = model.nodes.map(drawing.at);
  const left = Math.min(...box.map(([x]) => x)), bottom = Math.max(...box.map(([, y]) => y));
  const marks = [];
  for (const [k, way] of [look.right, look.up].entries()) {
    const at = lines(model, way, size).map((v) => ({ v, on: drawing.at(way.map((c) => c * v))[k] }));
    // Both ends come first, then what has room between them.
    for (const { v, on } of [...at.slice(0, 1), ...at.slice(-1), ...at.slice(1, -1)]) {
      const set = k === 0 ? drawing.names.centred(on, bottom + 20, bare(v)) : drawing.names.centred(left - 25, on + 3, bare(v));
      if (set) marks.push(k === 0 ? `M${on.toFixed(1)} ${(bottom + 8).toFixed(1)}v4` : `M${(left - 8).toFixed(1)} ${on.toFixed(1)}h-4`);
    }
    const reach = model.nodes.map((p) => dot(p, way));
    const whole = `${number(Math.max(...reach) - Math.min(...reach))} ${unit}`;
    if (k === 0) drawing.names.write(width / 2, height - 8, `${whole} in all`, 'middle', 'label');
    else element('text', { x: 12, y: height / 2, 'text-anchor': 'middle', class: 'label', transform: `rotate(-90 12 ${height / 2})` }, drawing.svg).textContent = `${whole} in all`;
  }
  element('path', { d: marks.join(''), fill: 'none', stroke: '#5b6875', 'stroke-width': 0.6 }, drawing.svg);
}

/** {svg, narrow}; nodes are named where there is room for it. */
export function modelDrawing(model, look, unit) {
  const drawing = sheet(model, look, 360, look === LOOKS.view ? 30 : 60);
  const panels = model.panels.map((p) => `${path(p.nodes.map((n) => drawing.at(model.nodes[n])))}z`);
  if (panels.length) element('path', { d: panels.join(''), fill: '#8fa3b5', 'fill-opacity': 0.12, stroke: 'none' }, drawing.svg);
  drawRest(drawing, model);
  drawMembers(drawing, model, straight(model));
  drawSupports(drawing, model);
  drawLines(drawing, model, look, unit);
  if (model.nodes.length <= 60) model.nodes.forEach((p, n) => drawing.names.put(drawing.at(p), model.node_names[n]));
  return drawing;
}

/** Some members by name, the others thin: {svg, narrow, left (names that found no place)}. */
export function membersDrawing(model, look, chosen) {
  const drawing = sheet(model, look);
  drawRest(drawing, model);
  drawMembers(drawing, model, straight(model), '#b9c3cd', 0.5);
  drawMembers(drawing, { members: chosen }, straight(model), '#c0392b', 1.6);
  for (const m of chosen) {
    const [a, b] = straight(model)(m).map(drawing.at);
    drawing.names.put([(a[0] + b[0]) / 2, (a[1] + b[1]) / 2], m.name, 'member');
  }
  drawSupports(drawing, model);
  return { svg: drawing.svg, narrow: drawing.narrow, left: drawing.names.left };
}

export function deformedDrawing(model, look, movements, largest, bows) {
  const drawing = sheet(model, look, 290);  // with four buckling modes on one sheet of Letter
  const scale = largest > 0 ? 0.05 * bounds(model.nodes).size / largest : 0;
  drawRest(drawing, model);
  drawMembers(drawing, model, straight(model), '#c3ccd5', 0.5);
  const index = new Map(model.members.map((m, k) => [m, k]));
  drawMembers(drawing, model, (m) => memberLine(m, model.nodes, movements, scale, 8, bows?.[index.get(m)]), null, 0.9);
  drawSupports(drawing, model);
  return { svg: drawing.svg, narrow: drawing.narrow, scale };
}

/** Loads of one case: arrows at nodes and along members, hatched panels. `arrows`: [{at: place, to: direction}]. */
export function loadDrawing(model, look, arrows, panels) {
  const drawing = sheet(model, look, 330);
  drawRest(drawing, model);
  drawMembers(drawing, model, straight(model), '#9aa7b4', 0.6);
  drawSupports(drawing, model);
  const loaded = panels.map((p) => `${path(model.panels[p].nodes.map((n) => drawing.at(model.nodes[n])))}z`);
  if (loaded.length) element('path', { d: loaded.join(''), fill: '#c0392b', 'fill-opacity': 0.14, stroke: 'none' }, drawing.svg);
  const largest = Math.max(0, ...arrows.map((a) => Math.hypot(...a.to)));
  const many = arrows.length > 300, [short, longer] = many ? [2, 8] : [6, 16];
  const marks = [];
  for (const { at, to } of arrows) {
    const size = Math.hypot(...to);
    if (!(size > 1e-9 * largest)) continue;
    const head = drawing.at(at), tip = drawing.at(at.map((v, i) => v + to[i] / size));
    const way = [tip[0] - head[0], tip[1] - head[1]], seen = Math.hypot(...way);
    if (seen < 1e-6) continue;
    const d = way.map((v) => v / seen), long = short + longer * size / largest, tipSize = many ? 1 : 2;
    const tail = [head[0] - d[0] * long, head[1] - d[1] * long];
    marks.push(path([tail, head]), path([-1, 0, 1].map((side) => (side ? [head[0] - tipSize * (2 * d[0] - side * d[1]), head[1] - tipSize * (2 * d[1] + side * d[0])] : head))));
  }
  element('path', { d: marks.join(''), fill: 'none', stroke: '#c0392b', 'stroke-width': many ? 0.3 : 0.8 }, drawing.svg);
  return drawing;
}

/** One quantity along a member: values at even stations. */
export function diagramDrawing(title, values, length, unit, lengthUnit) {
  const width = 330, height = 100, left = 10, right = 10, top = 22, bottom = 18;
  const svg = element('svg', { viewBox: `0 0 ${width} ${height}`, class: 'diagram' });
  const low = Math.min(0, ...values), high = Math.max(0, ...values), range = high - low || 1;
  const x = (k) => left + k / (values.length - 1) * (width - left - right);
  const y = (v) => top + (high - v) / range * (height - top - bottom);
  const line = values.map((v, k) => [x(k), y(v)]);
  element('path', { d: `${path([[x(0), y(0)], ...line, [x(values.length - 1), y(0)]])}z`, fill: '#3f6fa8', 'fill-opacity': 0.18, stroke: '#3f6fa8', 'stroke-width': 0.9 }, svg);
  element('path', { d: path([[x(0), y(0)], [x(values.length - 1), y(0)]]), stroke: '#1d2733', 'stroke-width': 0.8 }, svg);
  const text = (at, up, words, anchor) => { element('text', { x: at, y: up, 'text-anchor': anchor, class: 'label' }, svg).textContent = words; };
  text(left, 13, `${title}, ${unit}`, 'start');
  text(width - right, 13, `${number(low)} to ${number(high)}`, 'end');
  text(left, height - 4, '0', 'start');
  text(width - right, height - 4, `${number(length)} ${lengthUnit}`, 'end');
  return svg;
}
