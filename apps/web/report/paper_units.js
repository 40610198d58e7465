// Numbers on paper: of models in N and m in kN, kNm, mm, cm2 and N/mm2, with as many decimals as the largest number of the
// same unit needs for five digits. Other units stay as the model has them.

const SI = {
  N: [1e-3, 'kN'], 'N m': [1e-3, 'kNm'], 'N/m': [1e-3, 'kN/m'], 'N m/m': [1e-3, 'kNm/m'], m: [1e3, 'mm'], rad: [1e3, 'mrad'],
  m2: [1e4, 'cm2'], m4: [1e8, 'cm4'], 'N/m2': [1e-6, 'N/mm2'],
};
/** What rounding leaves of nothing, in the units above. */
const NOTHING = 1e-6;

const isSi = (units) => units.length === 'm' && units.force === 'N';

/** [factor, name] of a unit on paper. */
export function paperUnit(unit, units) {
  return (isSi(units) && SI[unit]) || [1, unit];
}

/** One quantity with its unit, in four digits. */
export function quantity(value, unit, units) {
  const [factor, name] = paperUnit(unit, units);
  const scaled = Math.abs(value * factor) < NOTHING && factor !== 1 ? 0 : value * factor;
  const digits = scaled === 0 ? 0 : Math.min(8, Math.max(0, 3 - Math.floor(Math.log10(Math.abs(scaled)))));
  return `${scaled.toFixed(digits)} ${name}`.trim();
}

/** Columns and rows of a table, converted; numbers become texts. `apart`: each column has decimals of its own. What has
 * the unit % is a share of 1. */
export function onPaper(columns, rows, units, apart) {
  const conversions = columns.map(([, unit]) => paperUnit(unit, units));
  const made = columns.map(([name], k) => [name, conversions[k][1]]);
  const largestOf = (k) => rows.reduce((most, row) => (typeof row[k] === 'number' ? Math.max(most, Math.abs(row[k] * conversions[k][0])) : most), 0);
  const texts = columns.map(([, unit], k) => {
    const [factor] = conversions[k];
    const alike = apart || unit === '' ? [k] : columns.map((_, c) => c).filter((c) => columns[c][1] === unit);
    const largest = Math.max(...alike.map(largestOf));
    const decimals = largest > 0 ? 4 - Math.floor(Math.log10(largest)) : 0;
    return (v) => {
      if (typeof v !== 'number') return v ?? '';
      if (unit === '%') return (100 * v).toFixed(1);
      const scaled = v * factor;
      if (scaled === 0 || (factor !== 1 && Math.abs(scaled) < NOTHING)) return '0';
      if (decimals > 8) return scaled.toExponential(3);
      const text = scaled.toFixed(Math.max(0, decimals));
      return Number(text) === 0 ? '0' : text;
    };
  });
  return { columns: made, rows: rows.map((row) => columns.map((_, k) => ({ text: texts[k](row[k]), number: typeof row[k] === 'number' }))) };
}

const LOAD_UNITS = { 'node load': ['N', 'N m'], 'point load': ['N', 'N m'], 'uniform load': ['N/m', 'N m/m'], 'trapezoid (at its start)': ['N/m', 'N m/m'] };

/** Rows of loads [case, on, what, value]: equal ones together, with their unit. */
export function loadRows(rows, units) {
  const groups = new Map();
  for (const [name, on, what, value] of rows) {
    const key = JSON.stringify([name, what, value]);
    if (!groups.has(key)) groups.set(key, { name, what, value, on: [] });
    groups.get(key).on.push(on);
  }
  return [...groups.values()].map(({ name, what, value, on }) => [name, on.length > 1 ? `${on.length}: ${on.join(', ')}` : on[0], what, loadText(what, value, units)]);
}

function loadText(what, value, units) {
  if (value === null || value === undefined) return '';
  if (what.endsWith('pressure')) return isSi(units) ? `${Number((value / 1e3).toPrecision(5))} kN/m2` : `${value} ${units.force ? `${units.force}/${units.length}2` : ''}`;
  const kinds = LOAD_UNITS[what];
  if (!kinds || typeof value !== 'string') return String(value);
  // "z -8000, rx 100": each component with its own unit.
  return value.split(', ').map((part) => {
    const [component, number] = part.split(' ');
    const [factor, name] = paperUnit(kinds[component.startsWith('r') ? 1 : 0], units);
    return `${component} ${Number((Number(number) * factor).toPrecision(6))} ${name}`;
  }).join(', ');
}
