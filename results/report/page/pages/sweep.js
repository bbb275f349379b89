export function sweepParts() {
  return [];
}
export function sweepFigures() {
  return [];
}
