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

/** A drawing of the model: {svg, at(point) on paper, size of the structure}. */
function sheet(model, look, height = 360) {
  const on = (p) => [dot(p, look.right), -dot(p, look.up)];
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (const p of model.nodes) {
    const q = on(p);
    for (let i = 0; i < 2; ++i) {
      low[i] = Math.min(low[i], q[i]);
      high[i] = Math.max(high[i], q[i]);
    }
  }
  const width = 680, margin = 34;
  const wide = Math.max(high[0] - low[0], 1e-9), tall = Math.max(high[1] - low[1], 1e-9);
  const scale = Math.min((width - 2 * margin) / wide, (height - 2 * margin) / tall);
  const paper = Math.min(height, tall * scale + 2 * margin);
  const shift = [(width - wide * scale) / 2 - low[0] * scale, margin - low[1] * scale];
  const svg = element('svg', { viewBox: `0 0 ${width} ${paper.toFixed(1)}`, class: 'drawing' });
  const at = (p) => on(p).map((v, i) => v * scale + shift[i]);
  return { svg, at, scale };
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
function drawLines(drawing, model) {
  const lines = model.lines ?? [];
  const parts = [];
  for (let k = 0; k + 1 < lines.length; k += 2) parts.push(path([model.nodes[lines[k]], model.nodes[lines[k + 1]]].map(drawing.at)));
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

/** Dimensions of the whole along the drawing's two ways, in the model's units. */
function drawSize(drawing, model, look, unit) {
  const reach = (d) => {
    const all = model.nodes.map((p) => dot(p, d));
    return Math.max(...all) - Math.min(...all);
  };
  if (Math.abs(look.right[0] - 0.8) < 1e-9) return;  // a slanted view has no true lengths
  const box = drawing.svg.viewBox.baseVal;
  element('text', { x: 340, y: box.height - 6, 'text-anchor': 'middle', class: 'label' }, drawing.svg).textContent = `${number(reach(look.right))} ${unit}`;
  const label = element('text', { x: 12, y: box.height / 2, 'text-anchor': 'middle', class: 'label', transform: `rotate(-90 12 ${box.height / 2})` }, drawing.svg);
  label.textContent = `${number(reach(look.up))} ${unit}`;
}

export function modelDrawing(model, look, unit) {
  const drawing = sheet(model, look);
  const panels = model.panels.map((p) => `${path(p.nodes.map((n) => drawing.at(model.nodes[n])))}z`);
  if (panels.length) element('path', { d: panels.join(''), fill: '#8fa3b5', 'fill-opacity': 0.12, stroke: 'none' }, drawing.svg);
  drawLines(drawing, model);
  drawMembers(drawing, model, straight(model));
  drawSupports(drawing, model);
  if (model.nodes.length <= 60)
    model.nodes.forEach((p, n) => {
      const [x, y] = drawing.at(p);
      element('text', { x: x + 3, y: y - 3, class: 'name' }, drawing.svg).textContent = model.node_names[n];
    });
  drawSize(drawing, model, look, unit);
  return drawing.svg;
}

export function deformedDrawing(model, look, movements, largest, bows) {
  const drawing = sheet(model, look);
  const scale = largest > 0 ? 0.05 * bounds(model.nodes).size / largest : 0;
  drawMembers(drawing, model, straight(model), '#c3ccd5', 0.5);
  const index = new Map(model.members.map((m, k) => [m, k]));
  drawMembers(drawing, model, (m) => memberLine(m, model.nodes, movements, scale, 8, bows?.[index.get(m)]), null, 0.9);
  drawSupports(drawing, model);
  return { svg: drawing.svg, scale };
}

/** Loads of one case: arrows at nodes and along members, hatched panels. `arrows`: [{at: place, to: direction}]. */
export function loadDrawing(model, look, arrows, panels) {
  const drawing = sheet(model, look);
  drawMembers(drawing, model, straight(model), '#9aa7b4', 0.6);
  drawSupports(drawing, model);
  const loaded = panels.map((p) => `${path(model.panels[p].nodes.map((n) => drawing.at(model.nodes[n])))}z`);
  if (loaded.length) element('path', { d: loaded.join(''), fill: '#c0392b', 'fill-opacity': 0.14, stroke: 'none' }, drawing.svg);
  const largest = Math.max(0, ...arrows.map((a) => Math.hypot(...a.to)));
  const marks = [];
  for (const { at, to } of arrows) {
    const size = Math.hypot(...to);
    if (!(size > 1e-9 * largest)) continue;
    const head = drawing.at(at), tip = drawing.at(at.map((v, i) => v + to[i] / size));
    const way = [tip[0] - head[0], tip[1] - head[1]], seen = Math.hypot(...way);
    if (seen < 1e-6) continue;
    const d = way.map((v) => v / seen), long = 6 + 16 * size / largest;
    const tail = [head[0] - d[0] * long, head[1] - d[1] * long];
    marks.push(path([tail, head]), path([[head[0] - 4 * d[0] - 2 * d[1], head[1] - 4 * d[1] + 2 * d[0]], head, [head[0] - 4 * d[0] + 2 * d[1], head[1] - 4 * d[1] - 2 * d[0]]]));
  }
  element('path', { d: marks.join(''), fill: 'none', stroke: '#c0392b', 'stroke-width': 0.8 }, drawing.svg);
  return drawing.svg;
}

/** One quantity along a member: values at even stations. */
export function diagramDrawing(title, values, length, unit, lengthUnit) {
  const width = 330, height = 96, left = 10, right = 10, top = 20, bottom = 16;
  const svg = element('svg', { viewBox: `0 0 ${width} ${height}`, class: 'diagram' });
  const low = Math.min(0, ...values), high = Math.max(0, ...values), range = high - low || 1;
  const x = (k) => left + k / (values.length - 1) * (width - left - right);
  const y = (v) => top + (high - v) / range * (height - top - bottom);
  const line = values.map((v, k) => [x(k), y(v)]);
  element('path', { d: `${path([[x(0), y(0)], ...line, [x(values.length - 1), y(0)]])}z`, fill: '#3f6fa8', 'fill-opacity': 0.18, stroke: '#3f6fa8', 'stroke-width': 0.9 }, svg);
  element('path', { d: path([[x(0), y(0)], [x(values.length - 1), y(0)]]), stroke: '#1d2733', 'stroke-width': 0.8 }, svg);
  const text = (at, up, words, anchor) => { element('text', { x: at, y: up, 'text-anchor': anchor, class: 'label' }, svg).textContent = words; };
  text(left, 11, `${title}, ${unit}`, 'start');
  text(width - right, 11, `${number(low)} to ${number(high)}`, 'end');
  text(left, height - 4, '0', 'start');
  text(width - right, height - 4, `${number(length)} ${lengthUnit}`, 'end');
  return svg;
}
