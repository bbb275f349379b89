// The section of a map with an axis of samples: how a quantity scatters, along the other axes and at a point of them, and
// which parameter it owes that to.
import { axisText, coordinateLabel, symbolText } from "../axes.js";
import { barFigure } from "../figures/bar_figure.js";
import { histogram } from "../figures/histogram.js";
import { quantileBands } from "../figures/quantile_bands.js";
import { choice, slider } from "../parts/controls.js";
import { element, section, table } from "../parts/elements.js";
import { figureCard } from "../parts/figure_card.js";
import { scatterAt, scatterOf, tornadoAt, worstPoint } from "../scatter.js";
import { numberText, quantityText, sentence, shareText, unitText, words } from "../units.js";

const digits = 4;
const shareName = (share) => `${numberText(100 * share, 4)} %`;

// The monotone first coordinates of the axes beside the samples that have several points.
const besideAxes = ({ map, statistics }) => statistics.axes.filter((a) => map.axes[a].size > 1);

function firstView(scatter, quantity) {
  const wide = besideAxes(scatter);
  const bySize = [...wide].sort((a, b) => scatter.map.axes[b].size - scatter.map.axes[a].size);
  return { quantity, index: worstPoint(scatter, quantity), along: bySize[0] ?? null };
}

function placeText(scatter, { index }, leftOut = []) {
  const { map } = scatter;
  return besideAxes(scatter)
    .filter((a) => !leftOut.includes(a))
    .map((a) => axisText(map, map.axes[a], index[a]))
    .join(", ");
}

const at = (place) => (place ? `at ${place},` : "");

function bandsFigure(scatter, view) {
  if (view.along === null || view.quantity.quantiles.length === 0) return null;
  const { map, statistics } = scatter;
  return quantileBands({
    title: () => {
      const along = map.axes[view.along].coordinates[0];
      return sentence(`${words(view.quantity.variable.name)} of the samples along ${symbolText(along.name)}`);
    },
    caption: () => placeText(scatter, view, [view.along]),
    spec: () => ({
      map,
      variable: view.quantity.variable,
      axis: view.along,
      coordinate: map.axes[view.along].coordinates[0],
      lines: view.quantity.quantiles.map(({ share, suffix }) => {
        const line = (end) =>
          statistics.line(view.quantity.variable.name + suffix + end, view.index, view.along);
        return { share, suffix, value: line(""), low: line("_low"), high: line("_high") };
      }),
    }),
  });
}

function histogramFigure(scatter, view) {
  const { map } = scatter;
  return histogram({
    title: () => sentence(`${words(view.quantity.variable.name)} of the samples`),
    caption: () => placeText(scatter, view),
    spec: () => ({
      variable: view.quantity.variable,
      values: map.line(view.quantity.variable, view.index, map.samples),
      quantiles: scatterAt(scatter, view.quantity, view.index).quantiles,
    }),
  });
}

function tornadoBars(scatter, { quantity, index }) {
  const { name, unit } = quantity.variable;
  return barFigure({
    name: `tornado_${name}`,
    title: sentence(`change of ${words(name)} by one standard deviation of each parameter`),
    caption: [
      "To first order at the mean of the samples; share of the variance in brackets.",
      placeText(scatter, { index }),
    ]
      .filter(Boolean)
      .join(" "),
    label: `change of ${words(name)}`,
    unit,
    bars: tornadoAt(scatter, quantity, index).map(({ parameter, change, share }) => ({
      name: symbolText(parameter),
      value: change,
      note: Number.isFinite(share) ? shareText(share) : "",
    })),
  });
}

// null if no quantity has derivatives by the parameters at any point.
function tornadoFigure(scatter, view) {
  if (tornadoAt(scatter, view.quantity, view.index).length === 0) return null;
  const now = () => tornadoBars(scatter, view);
  return {
    get name() {
      return now().name;
    },
    get title() {
      return now().title;
    },
    get caption() {
      return now().caption;
    },
    draw: (canvas) => now().draw(canvas),
    table: () => now().table(),
  };
}

const intervalText = ({ low, high }) => `${numberText(low, digits)} to ${numberText(high, digits)}`;

// Mean, deviation and quantiles of every quantity at the point, as numbers.
function numbersTable(scatter, { index }) {
  const shares = [
    ...new Set(scatter.quantities.flatMap(({ quantiles }) => quantiles.map(({ share }) => share))),
  ];
  const estimate = (one) => (one ? `${numberText(one.value)} (${intervalText(one)})` : "");
  const rows = scatter.quantities.map((quantity) => {
    const { mean, deviation, samples, quantiles } = scatterAt(scatter, quantity, index);
    return [
      words(quantity.variable.name),
      unitText(quantity.variable.unit),
      numberText(samples),
      estimate(mean),
      numberText(deviation),
      ...shares.map((share) => estimate(quantiles.find((one) => one.share === share))),
    ];
  });
  const head = [
    "quantity",
    "unit",
    "samples",
    "mean",
    "deviation",
    ...shares.map((share) => `${shareName(share)} quantile`),
  ];
  return table(head, rows, { caption: "95 % intervals in brackets." });
}

function sentences(scatter, { quantity, index }) {
  const { variable } = quantity,
    { quantiles, samples } = scatterAt(scatter, quantity, index);
  const highest = quantiles.at(-1);
  const told = (value) => quantityText(value, variable.unit, digits);
  const found = [];
  if (highest && Number.isFinite(highest.value)) {
    const interval = [highest.low, highest.high].every(Number.isFinite)
      ? `95 % interval ${told(highest.low)} to ${told(highest.high)}`
      : "too few samples for an interval";
    found.push(
      sentence(
        `${at(placeText(scatter, { index }))} ${shareName(highest.share)} of the ${numberText(samples)} samples have ${words(variable.name)} below ${told(highest.value)} (${interval}).`.trim(),
      ),
    );
  }
  const [first] = tornadoAt(scatter, quantity, index);
  if (first && Number.isFinite(first.share))
    found.push(
      `To first order ${shareText(first.share)} of the variance is due to ${symbolText(first.parameter)}.`,
    );
  return found.join(" ");
}

function controlsOf(scatter, view, change) {
  const wide = besideAxes(scatter),
    { map } = scatter;
  const names = scatter.quantities.map(({ variable }) => [variable.name, words(variable.name)]);
  return [
    choice("quantity shown", names, view.quantity.variable.name, (name) =>
      change({ quantity: scatter.quantities.find(({ variable }) => variable.name === name) }),
    ),
    wide.length > 1
      ? choice(
          "along",
          wide.map((a) => [a, coordinateLabel(map.axes[a].coordinates[0])]),
          view.along,
          (along) => change({ along: Number(along) }),
        )
      : null,
    ...wide.map(
      (axis) =>
        slider(
          map.axes[axis],
          () => view.index[axis],
          (to) => change({ index: view.index.map((i, a) => (a === axis ? to : i)) }),
        ).row,
    ),
  ].filter(Boolean);
}

// The section as a list; empty without samples.
export function scatterSection(record) {
  const scatter = scatterOf(record);
  if (!scatter) return [];
  const view = firstView(scatter, scatter.quantities[0]);
  const told = element("p", { class: "words" }),
    numbers = element("div", {});
  const cards = [bandsFigure, histogramFigure, tornadoFigure]
    .map((figure) => figure(scatter, view))
    .filter(Boolean)
    .map((figure) => figureCard(figure, record));
  const say = () => {
    told.textContent = sentences(scatter, view);
    numbers.replaceChildren(numbersTable(scatter, view));
  };
  const change = (changes) => {
    Object.assign(view, changes);
    say();
    cards.forEach((shown) => shown.redraw());
  };
  say();
  return [
    section(
      "Scatter",
      told,
      element("div", { class: "controls" }, ...controlsOf(scatter, view, change)),
      element("div", { class: "cards" }, ...cards.map(({ card }) => card)),
      numbers,
    ),
  ];
}

const mostFigures = 6; // quantities for papers

export function scatterFigures(record) {
  const scatter = scatterOf(record);
  if (!scatter) return [];
  return scatter.quantities.slice(0, mostFigures).flatMap((quantity) => {
    const view = firstView(scatter, quantity);
    return [bandsFigure, histogramFigure, tornadoFigure]
      .map((figure) => figure(scatter, view))
      .filter(Boolean);
  });
}
