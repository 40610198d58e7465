// What each table holds: columns with their units, and rows made from the results of the chosen combination.
import { units } from './format.js';

const SIX_FORCES = (u) => [['Fx', u.force], ['Fy', u.force], ['Fz', u.force], ['Mx', u.moment], ['My', u.moment], ['Mz', u.moment]];
const DIAGRAMS = (u) => [
  ['axial', u.force], ['shear_y', u.force], ['shear_z', u.force], ['torsion', u.moment], ['moment_y', u.moment],
  ['moment_z', u.moment], ['deflection_y', u.length], ['deflection_z', u.length],
];

const entries = (object) => Object.entries(object ?? {});
const reach = (extreme) => {
  if (!extreme) return null;
  return Math.abs(extreme.min[0]) > Math.abs(extreme.max[0]) ? extreme.min[0] : extreme.max[0];
};

/** Tables that have rows, in the order of their tabs: {id, title, columns: [[name, unit]], rows: () => [[name, ...]]}. */
export function tables(data, combination) {
  const u = units(data.results.units);
  const result = data.results.combinations[combination] ?? {};
  const list = [
    { id: 'members', title: 'Members', columns: [['member', ''], ['use', ''], ['governing', ''], ...DIAGRAMS(u)],
      rows: () => entries(result.members).map(([name, m]) => [name, m.utilisation, m.governing, ...DIAGRAMS(u).map(([d]) => reach(m.extremes?.[d]))]) },
    { id: 'design', title: 'Design checks', columns: [['member', ''], ['use', ''], ['governing', ''], ...Object.keys(data.results.design?.formulas ?? {}).map((clause) => [clause, ''])],
      rows: () => entries(result.members).filter(([, m]) => m.clauses).map(([name, m]) => [name, m.utilisation, m.governing, ...Object.keys(data.results.design.formulas).map((clause) => m.clauses[clause] ?? null)]) },
    { id: 'formulas', title: 'Formulas', columns: [['clause', ''], ['formula', '']], rows: () => entries(data.results.design?.formulas) },
    { id: 'joints', title: 'Joints', columns: [['joint', ''], ['use', ''], ['governing', '']],
      rows: () => entries(result.joints).map(([name, j]) => [name, j.utilisation, j.governing]) },
    { id: 'ends', title: 'End forces',
      columns: [['member', ''], ...[1, 2].flatMap((end) => SIX_FORCES(u).map(([n, unit]) => [`${n} end ${end}`, unit]))],
      rows: () => entries(result.members).map(([name, m]) => [name, ...(m.end_forces ?? [])]) },
    { id: 'displacements', title: 'Displacements',
      columns: [['node', ''], ['x', u.length], ['y', u.length], ['z', u.length], ['rx', u.angle], ['ry', u.angle], ['rz', u.angle]],
      rows: () => entries(result.displacements).map(([name, d]) => [name, ...d]) },
    { id: 'reactions', title: 'Reactions', columns: [['support', ''], ...SIX_FORCES(u)],
      rows: () => entries(result.reactions).map(([name, r]) => [name, ...r]) },
    { id: 'panels', title: 'Panels',
      columns: [['panel', ''], ...['nx', 'ny', 'nxy'].map((n) => [n, u.forcePerLength]), ...['mx', 'my', 'mxy'].map((n) => [n, u.momentPerLength]),
        ...['qx', 'qy'].map((n) => [n, u.forcePerLength])],
      rows: () => entries(result.panels).map(([name, p]) => [name, ...(p.membrane ?? []), ...(p.moments ?? []), ...(p.shears ?? [])]) },
    { id: 'cuts', title: 'Cuts', columns: [['cut', ''], ['part', ''], ['normal', u.force], ['shear along', u.force], ['shear across', u.force],
        ['torsion', u.moment], ['moment about along', u.moment], ['moment about across', u.moment]],
      rows: () => entries(result.cuts).flatMap(([name, cut]) => [[name, 'all', ...cut.resultant],
        ...[cut.members, cut.panels, cut.diaphragms].flatMap((of) => entries(of).map(([part, force]) => [name, part, ...force]))]) },
    { id: 'storeys', title: 'Storeys', columns: [['storey', ''], ['drift', 'of height'], ['use of the drift limit', ''], ['shear x', u.force], ['shear y', u.force]],
      rows: () => entries(result.storeys).map(([name, s]) => [name, s.drift, s.utilisation ?? null, ...s.shear]) },
    { id: 'envelope', title: 'Envelope', columns: [['member', ''], ['use', ''], ['in', ''], ...DIAGRAMS(u).slice(0, 6).flatMap(([n, unit]) => [[`${n} min`, unit], [`${n} max`, unit]])],
      rows: () => entries(data.results.envelope?.members).map(([name, e]) => [name, e.utilisation?.[0], e.utilisation?.[1],
        ...DIAGRAMS(u).slice(0, 6).flatMap(([n]) => [e[n]?.min?.[0], e[n]?.max?.[0]])]) },
    { id: 'losses', title: 'Column losses', columns: [['lost', ''], ['worst use', ''], ['worst joint', ''], ['survives', '']],
      rows: () => entries(data.results.losses).map(([name, by]) => {
        const loss = by[combination] ?? {};
        return loss.mechanism ? [name, null, 'mechanism', 'no'] : [name, loss.worst?.utilisation, loss.worst?.joint, loss.survives ? 'yes' : 'no'];
      }) },
    { id: 'buckling', title: 'Buckling', columns: [['mode', ''], ['factor', '']],
      rows: () => (data.results.buckling?.[combination] ?? []).map((b, k) => [String(k + 1), b.factor]) },
    { id: 'modes', title: 'Modes', columns: [['mode', ''], ['frequency', 'Hz'], ['angular frequency', 'rad/s'], ...['x', 'y', 'z', 'rx', 'ry', 'rz'].map((n) => [`mass share ${n}`, ''])],
      rows: () => (data.results.modes ?? []).map((m, k) => [String(k + 1), m.frequency, m.angular_frequency, ...(m.mass_share ?? [])]) },
    { id: 'sections', title: 'Sections', columns: [['section', ''], ...data.model.section_columns], rows: () => data.model.sections },
    { id: 'materials', title: 'Materials', columns: [['material', ''], ...data.model.material_columns], rows: () => data.model.materials },
    { id: 'loads', title: 'Loads', columns: [['case', ''], ['on', ''], ['what', ''], ['value', '']], rows: () => data.model.loads },
    { id: 'combinations', title: 'Combinations', columns: [['combination', ''], ['factors', '']], rows: () => data.model.combinations },
  ];
  return list.filter((table) => table.rows().length > 0);
}
