// The analysis report: one page, no network. The data stand in the page as JSON; see docs/report.md.
import { css, gradient, signedColour, useColour } from './colours.js';
import { forceLabel, number, percent, units } from './format.js';
import { buildPaper, setPaper } from './print.js';
import { StructureView } from './scene.js';
import { innerMotions } from './shape.js';
import { TableView } from './table_view.js';
import { tables } from './tables.js';

const data = JSON.parse(document.getElementById('data').textContent);
const { model, results } = data;
const unit = units(results.units);
const nodeIndex = new Map(model.node_names.map((name, k) => [name, k]));
const DIAGRAMS = ['axial', 'shear_y', 'shear_z', 'torsion', 'moment_y', 'moment_z'];
const DIAGRAM_AXIS = { axial: 2, shear_y: 1, shear_z: 2, torsion: 2, moment_y: 2, moment_z: 1 };

const state = { paper: /letter/i.test(location.hash) ? 'Letter' : 'A4', combination: Object.keys(results.combinations ?? {})[0], shape: 'deformed', scale: 1, colour: results.design ? 'members' : 'joints', diagram: 'none', reactions: true, panels: true, moving: false, selected: null };

const byNode = (shape) => {
  if (!shape) return null;
  const list = new Array(model.nodes.length).fill(null);
  for (const [name, value] of Object.entries(shape)) if (nodeIndex.has(name)) list[nodeIndex.get(name)] = value;
  list.inner = innerMotions(shape, (name) => nodeIndex.has(name));
  return list;
};

const combination = () => results.combinations[state.combination] ?? {};

/** The movement that is drawn, and its largest translation. */
function movement() {
  let shape = null;
  const [kind, k] = state.shape.split(':');
  if (kind === 'deformed') shape = combination().displacements;
  if (kind === 'mode') shape = results.modes?.[Number(k)]?.shape;
  if (kind === 'buckling') shape = results.buckling?.[state.combination]?.[Number(k)]?.shape;
  const list = byNode(shape);
  // Modes are scaled so that no point of any member moves by more than 1; the deformed shape says what moves most.
  if (list && kind !== 'deformed') return { list, largest: 1 };
  let largest = combination().largest_displacement?.value ?? 0;
  for (const d of list ?? []) if (d) largest = Math.max(largest, Math.hypot(d[0], d[1], d[2]));
  return { list, largest };
}

/** Utilisation of a member's two ends from its joints, and of the member itself. */
function useOf(m) {
  const { joints = {}, members = {} } = combination();
  return {
    ends: [joints[`${m.name}:1`]?.utilisation ?? null, joints[`${m.name}:2`]?.utilisation ?? null],
    member: members[m.name]?.utilisation ?? null,
    loss: results.losses?.[m.name]?.[state.combination],
  };
}

function stationValues(name, m) {
  const list = data.diagrams?.[state.combination]?.[m];
  const column = data.diagram_names.indexOf(name);
  return list ? list.map((row) => row[column]) : null;
}

/** Deflections [y, z] of every member from its chord, of the chosen combination. */
const bowsOf = new Map();
function bows() {
  if (!bowsOf.has(state.combination)) {
    const [y, z] = ['deflection_y', 'deflection_z'].map((name) => data.diagram_names.indexOf(name));
    bowsOf.set(state.combination, data.diagrams?.[state.combination]?.map((list) => list?.map((row) => [row[y], row[z]]) ?? null) ?? null);
  }
  return bowsOf.get(state.combination);
}

function colourRule() {
  const use = model.members.map(useOf);
  const n = view.segments;
  if (state.colour === 'joints') return (m, k) => useColour(2 * k < n ? use[m].ends[0] : 2 * k > n ? use[m].ends[1] : null);
  if (state.colour === 'members') return (m) => useColour(use[m].member);
  if (state.colour === 'losses') return (m) => (use[m].loss ? useColour(use[m].loss.mechanism ? 2 : use[m].loss.worst.utilisation) : useColour(null));
  if (DIAGRAMS.includes(state.colour)) {
    const values = model.members.map((_, m) => stationValues(state.colour, m));
    const largest = Math.max(1e-300, ...values.map((list) => (list ? Math.max(...list.map(Math.abs)) : 0)));
    return (m, k) => (values[m] ? signedColour(values[m][Math.round(k / n * (values[m].length - 1))] / largest) : useColour(null));
  }
  const kinds = { post: [0.30, 0.38, 0.48], beam: [0.45, 0.55, 0.66], brace: [0.62, 0.48, 0.30] };
  return (m) => kinds[model.members[m].kind] ?? kinds.beam;
}

const forceUnit = (name) => (name.startsWith('moment') || name === 'torsion' ? unit.moment : unit.force);

/** Least and largest value of one internal force over all members, at the exact places of its extremes. */
function reachOf(name) {
  let least = 0, most = 0;
  for (const m of Object.values(combination().members ?? {})) {
    const extreme = m.extremes?.[name];
    if (!extreme) continue;
    least = Math.min(least, extreme.min[0]);
    most = Math.max(most, extreme.max[0]);
  }
  return { least, most };
}

function highlighted(rule) {
  const chosen = model.members.findIndex((m) => m.name === state.selected || `${m.name}:1` === state.selected || `${m.name}:2` === state.selected);
  return (m, k) => (m === chosen ? [1, 0.45, 0] : rule(m, k));
}

function showLegend() {
  const legend = document.getElementById('legend');
  const bar = (colour, from, to, ends) => `<div class="bar" style="background:${gradient(colour, from, to)}"></div><div class="ends"><span>${ends[0]}</span><span>${ends[1]}</span></div>`;
  const titles = { joints: 'Use of the joints', members: 'Use of the members', losses: 'Worst use after the loss of the member' };
  if (titles[state.colour]) legend.innerHTML = `${titles[state.colour]}${bar(useColour, 0, 1, ['0', '1'])}<span style="color:${css(useColour(2))}">\u25a0</span> above 1 &nbsp; <span style="color:${css(useColour(null))}">\u25a0</span> none`;
  else if (DIAGRAMS.includes(state.colour)) {
    const { least, most } = reachOf(state.colour), largest = Math.max(Math.abs(least), Math.abs(most));
    const unitOf = forceUnit(state.colour);
    legend.innerHTML = `${state.colour.replace('_', ' ')}, ${unitOf}${bar(signedColour, -1, 1, [number(-largest), number(largest)])}`;
  }
  if (state.colour === 'kind') legend.innerHTML = '<span style="color:rgb(77,97,122)">\u25a0</span> posts &nbsp;<span style="color:rgb(115,140,168)">\u25a0</span> beams &nbsp;<span style="color:rgb(158,122,77)">\u25a0</span> braces';
  if (state.diagram !== 'none') {
    const { least, most } = reachOf(state.diagram);
    legend.innerHTML += `<div>Diagram: ${state.diagram.replace('_', ' ')} from ${number(least)} to ${number(most)} ${forceUnit(state.diagram)}</div>`;
  }
}

/** The factor on the movement at slider position 1: the largest movement is drawn as 4 % of the structure. */
function baseScale(largest) {
  return largest > 0 ? 0.04 * view.bounds.size / largest : 0;
}

function showShape(phase = 1) {
  const { list, largest } = movement();
  view.setShape(list, list ? baseScale(largest) * state.scale * phase : 0, state.shape === 'deformed' ? bows() : null);
  const most = combination().largest_displacement;
  const at = state.shape === 'deformed' && !state.moving && most?.node ? nodeIndex.get(most.node) : -1;
  view.setNodeLabels('largest', at >= 0 ? [{ node: at, text: `${most.node}: ${number(most.value)} ${unit.length}` }] : []);
  document.getElementById('factor').textContent = list ? `drawn ${number(Number((baseScale(largest) * state.scale).toPrecision(2)))} times as large` : '';
}

function refresh() {
  showShape();
  view.setColours(highlighted(colourRule()));
  view.setDiagram(state.diagram === 'none' ? null : model.members.map((_, m) => stationValues(state.diagram, m)), DIAGRAM_AXIS[state.diagram] ?? 2, signedColour);
  const reactions = Object.entries(combination().reactions ?? {}).filter(([name]) => nodeIndex.has(name));
  view.setArrows(state.reactions ? reactions.map(([name, r]) => ({ node: nodeIndex.get(name), force: r.slice(0, 3), text: forceLabel(Math.hypot(r[0], r[1], r[2]), unit.force) })) : []);
  view.setPanelsVisible(state.panels);
  showLegend();
}

function select(name) {
  state.selected = name;
  table.select(name);
  view.setColours(highlighted(colourRule()));
}

function control(label, options, key, onChange) {
  const box = document.createElement('label');
  box.textContent = label;
  const choice = document.createElement('select');
  choice.id = `choose-${key}`;
  for (const [value, text] of options) choice.add(new Option(text, value));
  choice.value = state[key];
  choice.addEventListener('change', () => {
    state[key] = choice.value;
    onChange();
  });
  box.append(choice);
  return box;
}

function check(label, key, onChange) {
  const box = document.createElement('label');
  box.className = 'check';
  const input = document.createElement('input');
  input.type = 'checkbox';
  input.checked = state[key];
  input.addEventListener('change', () => {
    state[key] = input.checked;
    onChange();
  });
  box.append(input, label);
  return box;
}

function buildControls() {
  const aside = document.getElementById('controls');
  const shapes = [['deformed', 'Deformed'], ['rest', 'Undeformed']];
  (results.modes ?? []).forEach((m, k) => shapes.push([`mode:${k}`, `Mode ${k + 1}: ${number(m.frequency)} Hz`]));
  (results.buckling?.[state.combination] ?? []).forEach((b, k) => shapes.push([`buckling:${k}`, `Buckling ${k + 1}: factor ${number(b.factor)}`]));
  if (!shapes.some(([value]) => value === state.shape)) state.shape = 'deformed';
  const colours = [['joints', 'Use of joints'], ['members', 'Use of members'], ['kind', 'Kind of member'], ...(results.losses ? [['losses', 'Column losses']] : []), ...DIAGRAMS.map((d) => [d, d.replace('_', ' ')])];
  const slider = document.createElement('label');
  slider.innerHTML = 'Scale of the shape <input id="scale" type="range" min="0" max="4" step="0.05"><span id="factor"></span>';
  slider.querySelector('input').value = state.scale;
  slider.querySelector('input').addEventListener('input', (event) => {
    state.scale = Number(event.target.value);
    showShape();
  });
  const home = document.createElement('button');
  home.textContent = 'Reset the view';
  home.addEventListener('click', () => {
    view.home();
    view.draw();
  });
  const print = document.createElement('button');
  print.textContent = 'Print';
  print.addEventListener('click', () => {
    buildPaper(data, state.paper);
    window.print();
  });
  aside.replaceChildren(
    control('Combination', Object.keys(results.combinations).map((c) => [c, c]), 'combination', () => {
      buildControls();
      table.show(tables(data, state.combination));
      showSummary();
      refresh();
    }),
    control('Shape', shapes, 'shape', refresh), slider,
    check('move to and fro', 'moving', animate),
    control('Colour', colours, 'colour', refresh),
    control('Diagram', [['none', 'None'], ...DIAGRAMS.map((d) => [d, d.replace('_', ' ')])], 'diagram', refresh),
    check('reactions', 'reactions', refresh), check('panels', 'panels', refresh), home,
    control('Paper', [['A4', 'A4'], ['Letter', 'US Letter']], 'paper', () => setPaper(state.paper)), print);
}

function animate() {
  if (!state.moving) {
    showShape();
    return;
  }
  showShape(Math.sin(performance.now() / 450));
  requestAnimationFrame(animate);
}

function definitions(title, pairs) {
  const box = document.createElement('div');
  box.innerHTML = '<h2></h2><dl></dl>';
  box.querySelector('h2').textContent = title;
  for (const [term, value] of pairs) {
    const dt = document.createElement('dt'), dd = document.createElement('dd');
    dt.textContent = term;
    dd.textContent = value;
    box.querySelector('dl').append(dt, dd);
  }
  return box;
}

function showSummary() {
  const c = combination();
  const largest = c.largest_displacement ?? { value: 0 };
  const place = largest.member ? ['in member', `${largest.member}, ${number(largest.at)} ${unit.length} from its first end`] : largest.node ? ['at node', largest.node] : ['within', 'a shell panel'];
  const worst = Object.entries(c.joints ?? {}).reduce((a, [name, j]) => (j.utilisation > a[1] ? [name, j.utilisation, j.governing] : a), ['', 0, '']);
  const worstMember = Object.entries(c.members ?? {}).reduce((a, [name, m]) => ((m.utilisation ?? -1) > a[1] ? [name, m.utilisation, m.governing] : a), ['', -1, '']);
  const total = [0, 0, 0];
  for (const r of Object.values(c.reactions ?? {})) for (let i = 0; i < 3; ++i) total[i] += r[i];
  const seconds = Object.values(results.seconds ?? {}).reduce((a, b) => a + b, 0);
  const boxes = [
    definitions('Model', [['nodes', model.nodes.length], ['members', results.model?.members ?? model.members.length], ['panels', model.panels.length], ['equations', results.model.freedoms]]),
    definitions(`Combination ${state.combination}`, [
      ['largest displacement', `${number(largest.value)} ${unit.length}`], place,
      ['sum of reactions z', `${number(total[2])} ${unit.force}`],
      ...(worstMember[0] ? [['most used member', `${worstMember[0]} (${worstMember[2]})`], ['its use', percent(worstMember[1])]] : []),
      ...(worst[0] ? [['most used joint', `${worst[0]} (${worst[2]})`], ['its use', percent(worst[1])]] : []),
    ]),
    definitions('How exact', [['backward error', number(c.backward_error)], ['equilibrium error', number(c.equilibrium_error)], ['condition', number(c.condition)], ['error bound', number(c.error_bound)]]),
    definitions('How', [['second order', results.settings?.p_delta ?? 'none'], ...(results.design ? [['design code', results.design.code], ['drift limit', `height/${number(1 / results.design.drift_limit)}`]] : []), ['factorisation', results.settings?.factorisation ?? ''], ['seconds', number(seconds)], ['Topple', results.topple]]),
  ];
  const warnings = [...new Set([...(model.sample ? [model.sample] : []), ...model.warnings, ...(model.result_warnings ?? [])])];
  if (warnings.length) {
    const box = document.createElement('div');
    box.innerHTML = '<h2>Warnings</h2>';
    for (const text of warnings) {
      const p = document.createElement('p');
      p.className = 'warning';
      p.textContent = text;
      box.append(p);
    }
    boxes.push(box);
  }
  document.getElementById('summary').replaceChildren(...boxes);
}

function hover(canvas) {
  const tip = document.getElementById('tooltip');
  const place = (event) => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top, box.width, box.height];
  };
  const found = (event) => {
    const [x, y, w, h] = place(event);
    return view.pick(2 * x / w - 1, 1 - 2 * y / h);
  };
  canvas.addEventListener('pointermove', (event) => {
    if (event.buttons) {
      tip.hidden = true;
      return;
    }
    const m = found(event);
    tip.hidden = m === null;
    if (m === null) return;
    const member = model.members[m], result = combination().members?.[member.name];
    const use = useOf(member);
    const lines = [`${member.name}  (${member.kind}, ${member.section}, ${member.material})`];
    for (const name of DIAGRAMS) {
      const extreme = result?.extremes?.[name];
      if (extreme) lines.push(`${name.replace('_', ' ')}  ${number(extreme.min[0])} to ${number(extreme.max[0])} ${forceUnit(name)}`);
    }
    use.ends.forEach((value, end) => value !== null && lines.push(`joint ${end + 1}  ${percent(value)}`));
    if (use.member !== null) lines.push(`member  ${percent(use.member)} by ${result.governing}`);
    tip.textContent = lines.join('\n');
    const [x, y] = place(event);
    tip.style.left = `${x + 14}px`;
    tip.style.top = `${y + 14}px`;
  });
  canvas.addEventListener('pointerleave', () => { tip.hidden = true; });
  let down = null;
  canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
  canvas.addEventListener('pointerup', (event) => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4) return;  // it turned the view
    const m = found(event);
    if (m !== null) select(model.members[m].name);
  });
}

document.title = model.title || model.file;
document.getElementById('title').textContent = model.title || model.file;
document.getElementById('subtitle').textContent = `${model.file}; lengths in ${unit.length || 'consistent units'}${unit.force ? `, forces in ${unit.force}` : ''}`;
const view = new StructureView(document.getElementById('canvas'), model);
const table = new TableView({ table: document.getElementById('table'), tabs: document.getElementById('tabs'), filter: document.getElementById('filter'), count: document.getElementById('rowcount'), onSelect: select });
if (results.diagnosis) {  // an unstable model: its motion is all there is to show
  results.combinations = { [results.diagnosis.combination]: { displacements: results.diagnosis.shape } };
  state.combination = results.diagnosis.combination;
  state.moving = true;
}
buildControls();
table.show(tables(data, state.combination));
showSummary();
hover(document.getElementById('canvas'));
refresh();
if (state.moving) animate();
setPaper(state.paper);
window.addEventListener('beforeprint', () => buildPaper(data, state.paper));
if (/print/i.test(location.hash)) buildPaper(data, state.paper);
