// Divides the flow of the printed report into sheets, each a page of its own. What stands on which page is thereby known before
// anything is printed, so that the contents can name pages: no browser can count them for a link yet (target-counter).

/** Sheets in mm: the paper less its margins, which stand in style.css under @page. */
const MARGINS = { across: 32, along: 38 };
export const PAPERS = { A4: [210, 297], Letter: [215.9, 279.4] };
/** Left free at the foot, in mm: text set for print may come out a line longer than what was measured. */
const SPARE = 4;
const PIXELS = 96 / 25.4;  // CSS pixels in a mm

/** A box that only holds others; it may go over several sheets. */
const divisible = (node) => ['SECTION', 'UL'].includes(node.tagName) && !node.matches('.cover');
/** What begins something stays with what comes next. */
const begins = (node) => /^H[1-6]$/.test(node.tagName) || node.matches('.audit > p, .intro, dl');

/** What is never divided, in order: {node, path (the boxes it stands in), table, keep, fresh (begins a page)}. */
function pieces(box, path = []) {
  const found = [];
  for (const node of [...box.children]) {
    if (node.tagName === 'TABLE') {
      const rows = [...node.tBodies[0].rows];
      rows.forEach((row, k) => found.push({ node: row, path, table: node, keep: rows.length > 1 && (k === 0 || k === rows.length - 2) }));
      if (!rows.length) found.push({ node, path, keep: false });
    } else if (divisible(node)) {
      const inside = pieces(node, [...path, node]);
      if (inside.length && node.matches('.fresh')) inside[0].fresh = true;
      found.push(...inside);
    } else {
      found.push({ node, path, keep: begins(node), fresh: node.matches('.fresh') });
    }
  }
  return found;
}

function measure(list) {
  for (const piece of list) {
    const box = piece.node.getBoundingClientRect();
    piece.top = box.top;
    piece.bottom = box.bottom;
    if (!piece.table) continue;
    const head = piece.table.tHead.getBoundingClientRect();
    piece.head = head.height;
    if (piece.node.sectionRowIndex === 0) piece.top = head.top;
  }
}

/** Columns keep their widths on every sheet. */
function fixColumns(table) {
  if (table.querySelector('colgroup')) return;
  const widths = [...table.tHead.rows[0].cells].map((cell) => cell.getBoundingClientRect().width);
  const group = document.createElement('colgroup');
  for (const width of widths) {
    const column = document.createElement('col');
    column.style.width = `${width}px`;
    group.append(column);
  }
  table.prepend(group);
  table.style.width = `${table.getBoundingClientRect().width}px`;
  table.style.tableLayout = 'fixed';
}

/** [first, last] of the pieces on each sheet. */
function divide(list, height) {
  const sheets = [];
  for (let first = 0; first < list.length;) {
    const start = list[first];
    const again = start.table && start.node.sectionRowIndex > 0 ? start.head : 0;
    let last = first;
    while (last + 1 < list.length && !list[last + 1].fresh && list[last + 1].bottom - start.top + again <= height) ++last;
    if (last + 1 < list.length && !list[last + 1].fresh) {
      let together = last;
      while (together > first && list[together].keep) --together;
      if (!list[together].keep) last = together;
    }
    sheets.push([first, last]);
    first = last + 1;
  }
  return sheets;
}

/** Puts the pieces into a new sheet, within copies of the boxes and tables that they stood in. */
function fill(sheet, list) {
  const copies = new Map();
  const copyOf = (box, parent) => {
    if (!copies.has(box)) {
      const copy = box.cloneNode(false);
      if (box.tagName === 'TABLE') copy.append(box.querySelector('colgroup').cloneNode(true), box.tHead.cloneNode(true), document.createElement('tbody'));
      parent.append(copy);
      copies.set(box, copy);
    }
    return copies.get(box);
  };
  for (const piece of list) {
    let place = sheet;
    for (const box of piece.path) place = copyOf(box, place);
    if (piece.table) place = copyOf(piece.table, place).tBodies[0];
    place.append(piece.node);
  }
}

/**
 * Lays the flow in `root` (shown at the paper's width by `root.className = 'measured'`) out on sheets. Afterwards each link
 * `a[href="#id"]` with a `.page` in it names the page of that id. Returns the number of pages.
 */
export function layOut(root, paper) {
  const [wide, tall] = PAPERS[paper];
  const height = (tall - MARGINS.along - SPARE) * PIXELS;
  root.style.width = `${wide - MARGINS.across}mm`;
  root.className = 'measured';
  const list = pieces(root);
  measure(list);
  for (const { table } of list) if (table) fixColumns(table);
  const pageOf = new Map();
  let page = 0;
  const sheets = divide(list, height).map(([first, last]) => {
    const sheet = document.createElement('div');
    sheet.className = 'sheet';
    ++page;
    const part = list.slice(first, last + 1);
    for (const { node } of part)
      for (const named of [node, ...node.querySelectorAll('[id]')]) if (named.id) pageOf.set(named.id, page);
    // A single piece may be taller than the paper: the browser then parts it over more pages.
    const over = list[last].bottom - list[first].top - (height + SPARE * PIXELS);
    if (over > 0) page += Math.ceil(over / (height + SPARE * PIXELS));
    return [sheet, part];
  });
  root.replaceChildren();
  for (const [sheet, part] of sheets) {
    root.append(sheet);
    fill(sheet, part);
  }
  for (const link of root.querySelectorAll('a[href^="#"]')) {
    const number = link.querySelector('.page');
    if (number) number.textContent = pageOf.get(link.getAttribute('href').slice(1)) ?? '';
  }
  root.className = '';
  root.style.width = '';
  return page;
}
