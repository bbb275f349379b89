// Columns as CSV: "name [unit]" above its numbers, as in frahm's own exports; missing values are empty.
// A column with `digits` is written to so many digits.
export function csvText(columns) {
  const rows = Math.max(0, ...columns.map((column) => column.values.length));
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const head = columns.map(({ name, unit }) => quoted(unit && unit !== "1" ? `${name} [${unit}]` : name));
  const lines = [head.join(",")];
  for (let row = 0; row < rows; ++row) {
    lines.push(
      columns
        .map(({ values, digits }) => {
          const value = values[row];
          if (typeof value === "string") return quoted(value);
          if (value === undefined || Number.isNaN(value)) return "";
          return String(digits ? Number(value.toPrecision(digits)) : value);
        })
        .join(","),
    );
  }
  return lines.join("\n") + "\n";
}
