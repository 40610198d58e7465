// A table that sorts by a click on a column and filters by text. Of very long ones only the first rows are put into the
// page; the filter reaches all of them.
import { number } from './format.js';

const SHOWN = 400;

export class TableView {
  constructor({ table, tabs, filter, count, onSelect }) {
    Object.assign(this, { table, tabs, filter, count, onSelect, chosen: null, order: { column: 0, down: false }, selected: null });
    filter.addEventListener('input', () => this.#fill());
  }

  /** Shows these tables; stays at the chosen one when it is still there. */
  show(list) {
    this.list = list;
    if (!list.some((t) => t.id === this.chosen)) this.chosen = list[0]?.id ?? null;
    this.tabs.replaceChildren(...list.map((t) => {
      const button = document.createElement('button');
      button.textContent = t.title;
      button.dataset.table = t.id;
      button.addEventListener('click', () => this.choose(t.id));
      return button;
    }));
    this.choose(this.chosen);
  }

  choose(id) {
    if (id !== this.chosen) this.order = { column: 0, down: false };
    this.chosen = id;
    for (const button of this.tabs.children) button.setAttribute('aria-selected', String(button.dataset.table === id));
    const current = this.list.find((t) => t.id === id);
    this.columns = current ? current.columns : [];
    this.rows = current ? current.rows() : [];
    this.#dropEmptyColumns();
    this.#findNoise();
    this.#fill();
  }

  /** A column in which no row has anything tells nothing. */
  #dropEmptyColumns() {
    const used = this.columns.map((_, k) => k === 0 || this.rows.some((row) => row[k] !== null && row[k] !== undefined && row[k] !== ''));
    if (used.every(Boolean)) return;
    this.columns = this.columns.filter((_, k) => used[k]);
    this.rows = this.rows.map((row) => row.filter((_, k) => used[k]));
    if (this.order.column >= this.columns.length) this.order = { column: 0, down: false };
  }

  /** What is smaller than rounding makes of the largest number with the same unit is shown as 0. */
  #findNoise() {
    const largest = new Map();
    for (const row of this.rows)
      row.forEach((cell, k) => {
        if (typeof cell === 'number') largest.set(this.columns[k][1], Math.max(largest.get(this.columns[k][1]) ?? 0, Math.abs(cell)));
      });
    this.noise = this.columns.map(([, unit]) => (unit ? 1e-11 * (largest.get(unit) ?? 0) : 0));
  }

  select(name) {
    this.selected = name;
    this.#fill();
    this.table.querySelector('tr.selected')?.scrollIntoView({ block: 'nearest' });
  }

  #sorted() {
    const text = this.filter.value.trim().toLowerCase();
    const rows = text ? this.rows.filter((row) => row.some((cell) => String(cell ?? '').toLowerCase().includes(text))) : [...this.rows];
    const { column, down } = this.order;
    const compare = new Intl.Collator(undefined, { numeric: true }).compare;
    rows.sort((a, b) => {
      const [p, q] = [a[column], b[column]];
      if (p === null || p === undefined) return 1;
      if (q === null || q === undefined) return -1;
      const order = typeof p === 'number' && typeof q === 'number' ? p - q : compare(String(p), String(q));
      return down ? -order : order;
    });
    return rows;
  }

  #fill() {
    const rows = this.#sorted();
    const head = document.createElement('thead');
    const line = head.insertRow();
    this.columns.forEach(([name, unit], k) => {
      const cell = document.createElement('th');
      cell.textContent = name + (this.order.column === k ? (this.order.down ? ' \u2193' : ' \u2191') : '');
      const label = document.createElement('span');
      label.className = 'unit';
      label.textContent = unit || '\u00a0';
      cell.append(label);
      if (rows.some((row) => typeof row[k] === 'string')) cell.className = 'text';
      cell.addEventListener('click', () => {
        this.order = { column: k, down: this.order.column === k ? !this.order.down : k > 0 };
        this.#fill();
      });
      line.append(cell);
    });
    const body = document.createElement('tbody');
    const shown = rows.slice(0, SHOWN);
    const picked = this.selected && rows.find((row) => row[0] === this.selected);
    if (picked && !shown.includes(picked)) shown.unshift(picked);
    for (const row of shown) {
      const tr = body.insertRow();
      tr.className = row[0] === this.selected ? 'selected' : '';
      row.forEach((cell, k) => {
        const td = tr.insertCell();
        td.textContent = number(typeof cell === 'number' && Math.abs(cell) < this.noise[k] ? 0 : cell);
        if (typeof cell === 'string') td.className = 'text';
      });
      tr.addEventListener('click', () => this.onSelect(row[0]));
    }
    this.table.replaceChildren(head, body);
    this.count.textContent = rows.length > shown.length ? `${shown.length} of ${rows.length} rows: filter or sort to reach the others` : `${rows.length} rows`;
  }
}
