// What a study's [compare] puts beside a quantity.
import { words } from "./units.js";

// The same quantity under the other law, or of the other response; undefined where it is not compared.
export function comparedWith(map, variable) {
  return map.variable(`${variable.name}_compared`);
}

// "as the frequency falls": what the long name of the compared quantity says after the quantity's own.
export function circumstance(compared, variable) {
  const own = `${variable.long_name ?? ""}, `;
  return compared.long_name?.startsWith(own) ? compared.long_name.slice(own.length) : words(compared.name);
}
