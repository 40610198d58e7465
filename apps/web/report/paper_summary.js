// The page that a reader turns to first: what was found, in a few numbers, before all that leads to it.
import { percent } from './format.js';
import { quantity } from './paper_units.js';

const entries = (object) => Object.entries(object ?? {});

/** Members that are checked, the most used first; of equally used ones those that the report follows. */
function checks({ results, model }) {
  const followed = new Set((model.audits ?? []).map((check) => check.member));
  const digits = (use) => Math.round(use * 1e6), last = (check) => Number(!followed.has(check.member));
  return entries(results.combinations).flatMap(([combination, c]) =>
    entries(c.members).filter(([, m]) => m.utilisation !== undefined && m.governing)
      .map(([member, m]) => ({ member, combination, use: m.utilisation, clause: m.governing, refused: m.not_verified })))
    .sort((a, b) => digits(b.use) - digits(a.use) || last(a) - last(b));
}

/** One sentence: whether all that was checked passes. */
export function verdict(data) {
  if (!data.results.design) return 'Members were not checked by a design code.';
  const all = checks(data), names = (list) => new Set(list.map((c) => c.member)).size;
  const over = names(all.filter((c) => c.use > 1)), refused = names(all.filter((c) => c.refused));
  const of = `${names(all)} members${data.model.sample ? ' in this report' : ''} by ${data.results.design.code}`;
  const clauses = 'What the code asks for beside that is listed under "Not checked".';
  if (over + refused === 0) return `All ${of} pass every clause that is checked. ${clauses}`;
  return `Of ${of}, ${over} are above 100 %${refused ? `, and ${refused} cannot be said to pass` : ''}. ${clauses}`;
}

/** Rows [what, one value for each combination]. */
export function combinationRows(data, u) {
  const { results } = data, all = entries(results.combinations);
  const row = (what, of) => [what, ...all.map(([name, c]) => of(c, name))];
  const rows = [
    row('largest displacement', (c) => {
      const most = c.largest_displacement ?? { value: 0 };
      return `${quantity(most.value, u.length, results.units)}, ${most.member ? `in ${most.member}` : most.node ? `at ${most.node}` : 'within a shell'}`;
    }),
    row('sum of vertical reactions', (c) => quantity(entries(c.reactions).reduce((sum, [, r]) => sum + r[2], 0), u.force, results.units)),
  ];
  const drift = (c) => entries(c.storeys).reduce((most, [name, s]) => (Math.abs(s.drift) > most.value ? { name, value: Math.abs(s.drift) } : most), { value: 0 });
  if (all.some(([, c]) => drift(c).value > 1e-9))
    rows.push(row('largest storey drift', (c) => (drift(c).value > 1e-9 ? `1/${Math.round(1 / drift(c).value)} in storey ${drift(c).name}` : '0')));
  if (results.buckling) rows.push(row('lowest buckling factor', (_, name) => results.buckling[name]?.[0]?.factor.toFixed(3) ?? 'none found'));
  if (results.design) {
    const most = checks(data);
    rows.push(row('most used member', (_, name) => {
      const first = most.find((c) => c.combination === name);
      return first ? `${first.member}, ${percent(first.use)}` : '';
    }));
  }
  return rows;
}

/** Of every section the member that is used most. */
export function sectionRows(data) {
  const section = new Map(data.model.members.map((m) => [m.name, m.section]));
  const found = new Map();
  for (const check of checks(data)) {
    const name = section.get(check.member);
    if (!found.has(name)) found.set(name, { worst: check, members: new Set() });
    found.get(name).members.add(check.member);
  }
  return [...found].map(([name, { worst, members }]) => [name, String(members.size), worst.member, worst.combination, worst.clause, percent(worst.use),
    worst.refused ? 'not verified' : worst.use > 1 ? 'no' : 'yes']);
}
