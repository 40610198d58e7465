// Numbers and units as a person reads them.

/** A number with five significant digits; small and large ones with an exponent. */
export function number(value) {
  if (value === null || value === undefined) return '';
  if (typeof value !== 'number') return String(value);
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-3) return value.toExponential(4);
  return String(Number(value.toPrecision(5)));
}

export const percent = (value) => `${(100 * value).toFixed(1)} %`;

/** Unit of a quantity in the model's units; consistent units have no names. */
export function units(model) {
  if (model.length === 'consistent') {
    return { length: '', force: '', moment: '', angle: 'rad', mass: '', forcePerLength: '', momentPerLength: '' };
  }
  const { length, force, mass } = model;
  return {
    length, force, mass, angle: 'rad', moment: `${force} ${length}`, forcePerLength: `${force}/${length}`,
    momentPerLength: `${force} ${length}/${length}`,
  };
}

/** A force as short as a label wants it: three digits, in kN or MN where the unit is N. */
export function forceLabel(value, unit) {
  const size = Math.abs(value);
  const [factor, name] = unit !== 'N' || size < 1e3 ? [1, unit] : size < 1e6 ? [1e3, 'kN'] : [1e6, 'MN'];
  return `${number(Number((value / factor).toPrecision(3)))} ${name}`;
}
