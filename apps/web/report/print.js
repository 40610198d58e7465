// The report on paper: cover, contents, drawings, results, checks with every intermediate value, tables whole. Built when the
// page is printed (or at once for `#print`, as a headless browser does), from the same data as the screen's.
import { deformedDrawing, diagramDrawing, loadDrawing, LOOKS, membersDrawing, modelDrawing } from './drawings.js';
import { number, percent, units } from './format.js';
import { combinationRows, sectionRows, verdict } from './paper_summary.js';
import { loadRows, onPaper, paperUnit, quantity } from './paper_units.js';
import { innerMotions } from './shape.js';
import { layOut } from './sheets.js';
import { tables } from './tables.js';

/** A table with more rows than this is printed by a selection that it states. */
const WHOLE = 600;
const SELECTED = 150;

function make(name, text = '', className = '') {
  const made = document.createElement(name);
  if (text !== '') made.textContent = text;
  if (className) made.className = className;
  return made;
}

/** A line of the contents: a link and, once the sheets are laid out, the page. */
function contentsLine(title, id, level) {
  const link = make('a', '', `level${level}`);
  link.href = `#${id}`;
  link.append(make('span', title), make('span', '', 'dots'), make('span', '0', 'page'));
  return link;
}

class Paper {
  constructor(root, contents) {
    this.root = root;
    this.contents = contents;
    this.count = 0;
    this.parts = 0;
  }

  chapter(title) {
    const section = make('section', '', this.count ? 'chapter' : 'chapter fresh');
    const heading = make('h2', `${++this.count}. ${title}`);
    heading.id = `p${this.count}`;
    this.parts = 0;
    section.append(heading);
    this.contents.append(contentsLine(heading.textContent, heading.id, 1));
    this.root.append(section);
    return section;
  }

  /** A heading within the last chapter that the contents name as well. */
  part(title, short = title) {
    const heading = make('h3', title);
    heading.id = `p${this.count}-${++this.parts}`;
    this.contents.append(contentsLine(short, heading.id, 2));
    return heading;
  }
}

/** A cell with more characters goes over several rows, so that no row is taller than a sheet. */
const LONGEST = 1500;

/** Texts of at most LONGEST characters, parted at blanks. */
function parted(text) {
  const parts = [];
  let rest = text;
  while (rest.length > LONGEST) {
    const at = rest.lastIndexOf(' ', LONGEST);
    parts.push(rest.slice(0, at > 0 ? at : LONGEST));
    rest = rest.slice(at > 0 ? at + 1 : LONGEST);
  }
  return [...parts, rest];
}

/** A table of cells {text, number}; columns of numbers are aligned at the right, heads included. */
function tableOf(columns, rows) {
  const made = make('table', '', 'print');
  const head = made.createTHead().insertRow();
  columns.forEach(([name, unit], k) => {
    const cell = make('th', name.replaceAll('_', ' '), rows.some((row) => row[k].text !== '' && !row[k].number) || !rows.length ? 'text' : '');
    if (unit) cell.append(make('span', unit, 'unit'));
    head.append(cell);
  });
  const body = made.createTBody();
  for (const row of rows) {
    const texts = row.map((cell) => parted(String(cell.text)));
    for (let part = 0; part < Math.max(...texts.map((t) => t.length)); ++part) {
      const line = body.insertRow();
      row.forEach((cell, k) => {
        const td = line.insertCell();
        td.textContent = texts[k][part] ?? '';
        if (!cell.number) td.className = 'text';
      });
    }
  }
  return made;
}

const table = (columns, rows) => tableOf(columns, rows.map((row) => row.map((cell) => ({ text: number(cell), number: typeof cell !== 'string' }))));

/** A table in the units of paper. */
function measured(columns, rows, u, apart) {
  const converted = onPaper(columns, rows, u, apart);
  const made = tableOf(converted.columns, converted.rows);
  if (columns.length <= 3) made.classList.add('narrow');
  return made;
}

function figure(svg, caption) {
  const made = make('figure');
  made.append(svg, make('figcaption', caption));
  return made;
}

/** Drawings [{svg, narrow}, caption] below each other; narrow ones that follow one another stand two by two. */
function place(chapter, drawings) {
  let pair = null;
  for (const [drawing, caption] of drawings) {
    if (!drawing.narrow) pair = null;
    else if (!pair || pair.childElementCount === 2) chapter.append((pair = make('div', '', 'pairs')));
    (drawing.narrow ? pair : chapter).append(figure(drawing.svg, caption));
  }
}

function cover(data, root) {
  const { model, results } = data;
  const page = make('section', '', 'cover fresh');
  // A long title is a name and what is said of it: on the cover the name stands alone.
  const whole = model.title || model.file;
  const end = whole.length > 80 ? whole.search(/[.:;,] /) : -1;
  page.append(make('p', 'Structural analysis', 'kind'), make('h1', end > 0 ? whole.slice(0, end) : whole));
  if (end > 0) page.append(make('p', whole.slice(end + 2)));
  const u = results.units;
  const facts = [['Project', model.project || 'not given (--project)'], ['Author', model.author || 'not given (--author)'], ['Date', model.date],
    ['Model', model.file], ['Units', u.length === 'consistent' ? 'consistent' : `${u.length}, ${u.force}, ${u.mass}, rad`],
    ['Program', `Topple ${results.topple}${model.commit ? `, commit ${model.commit}` : ''}`],
    ['Second order', results.settings?.p_delta ?? 'none'], ['Design code', results.design?.code ?? 'not checked']];
  const list = make('dl');
  for (const [term, value] of facts) list.append(make('dt', term), make('dd', value));
  page.append(list);
  root.append(page);
}

function drawSummary(paper, data, u) {
  const chapter = paper.chapter('Summary');
  chapter.append(make('p', verdict(data), 'verdict'));
  const combinations = Object.keys(data.results.combinations ?? {});
  if (combinations.length) {
    // Side by side up to four; more go below each other.
    for (let from = 0; from < combinations.length; from += 4) {
      const rows = combinationRows(data, u).map((row) => [row[0], ...row.slice(1 + from, 5 + from)]);
      chapter.append(table([['', ''], ...combinations.slice(from, from + 4).map((name) => [name, ''])], rows));
    }
  }
  const modes = data.results.modes ?? [];
  if (modes.length) chapter.append(make('p', `Natural frequencies: ${modes.slice(0, 6).map((m) => `${Number(m.frequency.toPrecision(4))} Hz`).join(', ')}.`));
  const sections = data.results.design ? sectionRows(data) : [];
  if (sections.length) {
    chapter.append(make('h3', 'Most used member of every section'));
    chapter.append(table([['section', ''], ['members', ''], ['most used', ''], ['combination', ''], ['clause', ''], ['use', ''], ['passes', '']], sections));
  }
}

function drawModel(paper, data, u) {
  const chapter = paper.chapter('Model');
  const { model } = data;
  chapter.append(make('p', `${model.nodes.length} nodes, ${data.results.model.members} members, ${model.panels.length} panels, ${data.results.model.freedoms} equations. Posts are drawn black, beams blue, braces brown; supports as triangles; numbers along the drawings are coordinates of posts and storeys in ${u.length || 'units of length'}.`, 'intro'));
  if (model.sample) chapter.append(make('p', model.sample));
  place(chapter, Object.values(LOOKS).map((look) => [modelDrawing(model, look, u.length), look.title]));
}

function drawLoads(paper, data) {
  const chapter = paper.chapter('Loads and combinations');
  const { model } = data;
  chapter.append(table([['combination', ''], ['factors', '']], model.combinations));
  place(chapter, (model.load_drawings ?? []).map((load) => {
    const text = `Case ${load.name}${load.self_weight ? ', with self weight' : ''}${load.left_out ? `; ${load.left_out} loads are not drawn` : ''}. ${whatIsDrawn(data, load)}`;
    return [loadDrawing(model, LOOKS.view, load.arrows, load.panels), text];
  }));
}

/** The values behind a drawing of loads. */
function whatIsDrawn(data, load) {
  const { units: names } = data.results;
  const parts = [];
  const pressures = data.model.loads.filter(([name, , what]) => name === load.name && what.endsWith('pressure'));
  const values = [...new Set(pressures.map(([, , , value]) => value))].sort((a, b) => a - b);
  const texts = values.map((v) => loadRows([[load.name, '', 'pressure', v]], names)[0][3]);
  if (texts.length) parts.push(`Loaded panels (${pressures.length}) are red: ${texts.length > 4 ? `${texts[0]} to ${texts[texts.length - 1]}` : texts.join(', ')}.`);
  const largest = load.arrows.reduce((most, a) => Math.max(most, Math.hypot(...a.to)), 0);
  if (largest > 0) {
    const [factor, name] = paperUnit(names.force, names);
    parts.push(`Arrows are as long as their loads, resultants where they are spread; the longest is ${number(largest * factor)} ${name}.`);
  }
  return parts.join(' ');
}

function byNode(model, shape) {
  const list = model.node_names.map((name) => shape?.[name] ?? null), names = new Set(model.node_names);
  list.inner = innerMotions(shape, (name) => names.has(name));
  return list;
}

function drawResults(paper, data, u) {
  const { model, results } = data;
  const [y, z] = ['deflection_y', 'deflection_z'].map((name) => data.diagram_names.indexOf(name));
  for (const [name, c] of Object.entries(results.combinations ?? {})) {
    const chapter = paper.chapter(`Results: ${name}`);
    const largest = c.largest_displacement ?? { value: 0 };
    const where = largest.member ? `in member ${largest.member}, ${number(largest.at)} ${u.length} from its first end` : largest.node ? `at node ${largest.node}` : 'within a shell panel';
    const sum = [0, 1, 2].map((i) => Object.values(c.reactions ?? {}).reduce((a, r) => a + r[i], 0));
    const facts = [['largest displacement', `${quantity(largest.value, u.length, results.units)} ${where}`],
      ['sum of reactions x, y, z', sum.map((v) => quantity(Math.abs(v) < 1e-9 * Math.hypot(...sum) ? 0 : v, u.force, results.units)).join(', ')],
      ['equations solved', `backward error ${number(c.backward_error)}, equilibrium error ${number(c.equilibrium_error)}`],
      ...(c.discretisation_error ? [['shell meshes', `estimated error of stresses ${percent(c.discretisation_error)}`]] : [])];
    const list = make('dl');
    for (const [term, value] of facts) list.append(make('dt', term), make('dd', value));
    chapter.append(list);
    const bows = data.diagrams?.[name]?.map((rows) => rows?.map((row) => [row[y], row[z]]) ?? null);
    const drawing = deformedDrawing(model, LOOKS.view, byNode(model, c.displacements), largest.value, bows);
    place(chapter, [[drawing, `Deformed, ${number(Number(drawing.scale.toPrecision(2)))} times as large`]]);
    const pairs = make('div', '', 'pairs');
    (results.buckling?.[name] ?? []).slice(0, 4).forEach((mode, k) => {
      const shape = deformedDrawing(model, LOOKS.view, byNode(model, mode.shape), 1, null);
      pairs.append(figure(shape.svg, `Buckling mode ${k + 1}, factor ${number(mode.factor)}`));
    });
    chapter.append(pairs);
  }
  const pairs = make('div', '', 'pairs');
  (results.modes ?? []).slice(0, 6).forEach((mode, k) => {
    if (k === 0) paper.chapter('Natural modes').append(pairs);
    pairs.append(figure(deformedDrawing(model, LOOKS.view, byNode(model, mode.shape), 1, null).svg, `Mode ${k + 1}, ${number(mode.frequency)} Hz`));
  });
}

function audit(data, check, u, paper) {
  const made = make('section', '', 'audit');
  made.append(paper.part(`${check.member}: ${percent(check.use)} by ${check.governing}, combination ${check.combination}`, `${check.member}, ${check.section}`));
  made.append(make('p', `Section ${check.section}, material ${check.material}, length ${number(check.length)} ${u.length}. ${check.formula}`));
  made.append(make('p', check.lengths));
  if (check.refusal) made.append(make('p', `Not said to pass: ${check.refusal}.`, 'warning'));
  const stations = data.diagrams?.[check.combination]?.[data.model.members.findIndex((m) => m.name === check.member)];
  if (stations) {
    const row = make('div', '', 'diagrams');
    const column = (name) => stations.map((s) => s[data.diagram_names.indexOf(name)]);
    const most = (quantities) => Math.max(...quantities.flatMap((q) => column(q).map(Math.abs)));
    const force = most(['axial', 'shear_y', 'shear_z']), moment = Math.max(most(['torsion', 'moment_y', 'moment_z']), force * check.length);
    const noise = { force: 1e-9 * force, moment: 1e-9 * moment, length: 1e-9 * check.length };
    for (const [name, kind] of [['axial', 'force'], ['shear_z', 'force'], ['moment_y', 'moment'], ['deflection_z', 'length']]) {
      const [factor, unit] = paperUnit(u[kind], data.results.units);
      const values = column(name).map((v) => (Math.abs(v) < noise[kind] ? 0 : factor * v));
      row.append(diagramDrawing(name.replace('_', ' '), values, check.length, unit, u.length));
    }
    made.append(row);
  }
  const steps = table([['clause', ''], ['quantity', ''], ['how', ''], ['value', ''], ['unit', '']], check.steps);
  const clauses = table([['clause', ''], ['use', ''], ['formula', '']], check.clauses.map(([clause, use, formula]) => [clause, percent(use), formula]));
  for (const part of [steps, clauses]) part.classList.add('steps');
  made.append(steps, clauses);
  return made;
}

function drawChecks(paper, data, u) {
  if (!data.results.design) return;
  const chapter = paper.chapter('Design checks');
  chapter.append(make('p', `${data.results.design.code}. ${data.model.audit_selection ?? ''}`));
  chapter.append(paper.part('Not checked'));
  const list = make('ul');
  for (const text of data.results.design.not_checked ?? []) list.append(make('li', text));
  chapter.append(list);
  const audits = data.model.audits ?? [];
  const chosen = audits.map((check) => data.model.members.find((m) => m.name === check.member)).filter(Boolean);
  if (chosen.length) {
    const where = membersDrawing(data.model, LOOKS.view, chosen);
    place(chapter, [[where, `Members that are followed below${where.left ? `; ${where.left} names find no room` : ''}`]]);
  }
  for (const check of audits) chapter.append(audit(data, check, u, paper));
}

/** Whole, or the rows with the largest use (else the first ones), with a word. */
function selection(rows, columns) {
  if (rows.length <= WHOLE) return [rows, `${rows.length} rows, all.`];
  const use = columns.findIndex(([name]) => name === 'use' || name === 'worst use');
  const chosen = use < 0 ? rows.slice(0, SELECTED) : [...rows].sort((a, b) => (b[use] ?? -1) - (a[use] ?? -1)).slice(0, SELECTED);
  return [chosen, `${chosen.length} of ${rows.length} rows: ${use < 0 ? 'the first ones' : 'those of the largest use'}; all are in results.json and the tables of --csv.`];
}

/** What all clauses of a code begin with says nothing at the head of a column. */
const CODES = /^(EN 1993-1-1|AISC 360) /;

/** [columns beside the first that hold something, names of those that hold zeros alone]. */
function telling(columns, rows, u) {
  const texts = onPaper(columns, rows, u).rows;
  const holds = (k, empty) => texts.some((row) => !empty.includes(String(row[k].text)));
  const behind = columns.map((_, k) => k).slice(1);
  const zeros = behind.filter((k) => columns[k][1] && columns[k][1] !== '%' && holds(k, ['']) && !holds(k, ['', '0']));
  return [behind.filter((k) => holds(k, ['']) && !zeros.includes(k)), zeros.map((k) => columns[k][0])];
}

/** Wide tables go over several, each with the first column. */
function drawTables(paper, data) {
  const most = 10;  // columns beside the first
  for (const combination of Object.keys(data.results.combinations ?? {})) {
    for (const t of tables(data, combination)) {
      const shared = ['sections', 'materials', 'loads', 'combinations', 'modes', 'formulas', 'envelope'].includes(t.id);
      if (shared && combination !== Object.keys(data.results.combinations)[0]) continue;
      const chapter = paper.chapter(shared ? t.title : `${t.title}: ${combination}`);
      if (t.id === 'loads') {
        chapter.append(table(t.columns, loadRows(t.rows(), data.results.units)));
        continue;
      }
      const [rows, words] = selection(t.rows(), t.columns);
      const isShare = (k) => k > 0 && (t.id === 'design' ? t.columns[k][0] !== 'governing' : /^(worst )?use$|^mass share/.test(t.columns[k][0]));
      const all = t.columns.map(([name, unit], k) => [name.replace(CODES, ''), isShare(k) ? '%' : unit]);
      const [used, zeros] = telling(all, rows, data.results.units);
      chapter.append(make('p', `${words}${zeros.length ? ` Left out, as all of it is 0: ${zeros.join(', ').replaceAll('_', ' ')}.` : ''}`, 'intro'));
      const wide = Math.ceil(used.length / Math.ceil(used.length / most)) || 1;  // parts of about the same width
      for (let from = 0; from < Math.max(1, used.length); from += wide) {
        const part = [0, ...used.slice(from, from + wide)];
        const columns = part.map((k) => all[k]);
        const bare = (cell, k) => (t.columns[k][0] === 'governing' ? cell?.replace(CODES, '') : cell);
        chapter.append(measured(columns, rows.map((row) => part.map((k) => bare(row[k], k))), data.results.units, t.id === 'sections'));
      }
    }
  }
}

let built = null;  // the size of the sheets that stand in the page

/** Builds the sheets of `size` ('A4' or 'Letter') where they are not there yet. */
export function buildPaper(data, size) {
  if (built === size) return;
  built = size;
  const root = document.getElementById('paper');
  const u = units(data.results.units);
  root.replaceChildren();
  cover(data, root);
  const contents = make('section', '', 'contents fresh');
  contents.append(make('h2', 'Contents'));
  root.append(contents);
  const paper = new Paper(root, contents);
  drawSummary(paper, data, u);
  const warnings = [...new Set([...(data.model.warnings ?? []), ...(data.model.result_warnings ?? [])])];
  if (warnings.length || data.results.unfinished) {
    const chapter = paper.chapter('Warnings');
    const list = make('ul');
    for (const text of [...(data.results.unfinished ?? []).map((t) => `not computed: ${t}`), ...warnings]) list.append(make('li', text));
    chapter.append(list);
  }
  drawModel(paper, data, u);
  drawLoads(paper, data);
  drawResults(paper, data, u);
  drawChecks(paper, data, u);
  drawTables(paper, data);
  layOut(root, size);
}

/** Size of the sheet: 'A4' or 'Letter'. */
export function setPaper(size) {
  let style = document.getElementById('papersize');
  if (!style) {
    style = make('style');
    style.id = 'papersize';
    document.head.append(style);
  }
  style.textContent = `@page { size: ${size}; }`;
}
