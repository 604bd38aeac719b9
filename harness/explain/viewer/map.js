// The map of an image: one color for each pixel, or outlines of beams. A click selects a pixel.

const RAMP = [[13, 8, 60], [95, 20, 110], [190, 55, 85], [240, 125, 35], [252, 230, 130]];
const COLORS = { goesOn: "#9aa4af", occupied: "#e69f00", leaves: "#4da3e0", single: "#d55e00", order: "#009e73",
  regrouped: "#cc79a7", handed: "#f0e442" };
const WAYS = [["single ray", COLORS.single], ["background, no ray", COLORS.leaves], ["block of neighbors", COLORS.order],
  ["regrouped block", COLORS.regrouped], ["block, then single ray", COLORS.handed]];
const SIDES = ["+x", "-x", "+y", "-y", "+z", "-z"];
const SIDE_COLORS = ["#d55e00", "#e69f00", "#009e73", "#8bd450", "#0072b2", "#cc79a7"];

function rampColor(part) {
  const place = Math.min(Math.max(part, 0), 1) * (RAMP.length - 1);
  const low = Math.min(Math.floor(place), RAMP.length - 2);
  const mixed = RAMP[low].map((value, i) => Math.round(value + (place - low) * (RAMP[low + 1][i] - value)));
  return `rgb(${mixed.join()})`;
}

/** Returns a color for a number; neighboring numbers get different colors. */
const numberedColor = (value) => `hsl(${(value * 137.5) % 360}, 55%, ${45 + (value % 3) * 10}%)`;

function rampMode(name, title, values, unit) {
  const most = values.reduce((a, b) => Math.max(a, Number.isFinite(b) ? b : 0), 0) || 1;
  return {
    name, title, color: (ray) => (Number.isFinite(values[ray]) ? rampColor(values[ray] / most) : "#00000000"),
    legend: [[`0 to ${oneDigit(most)} ${unit}`, `linear-gradient(90deg, ${RAMP.map((c) => `rgb(${c})`).join()})`]],
    text: (ray) => (Number.isFinite(values[ray]) ? `${oneDigit(values[ray])} ${unit}` : "nothing is hit"),
  };
}

/** Returns the modes of a structure's map; the first is shown first. */
function mapModes(data, structure, work) {
  const rays = data.image.width * data.image.height;
  const modes = [];
  if (structure.beams) {
    const { kinds } = structure.beams;
    const count = (kind) => number(kinds.filter((each) => each === kind).length);
    modes.push({
      name: "beams", title: "what becomes of the beams", outlines: structure.beams, color: () => "#00000000",
      shown: new Set([BEAM.leaves, BEAM.occupied, BEAM.goesOn]),
      legend: [[`left the scene: background, no ray (${count(BEAM.leaves)})`, COLORS.leaves, BEAM.leaves],
        [`met an occupied leaf: rays start there (${count(BEAM.occupied)})`, COLORS.occupied, BEAM.occupied],
        [`passed an empty leaf and continued (${count(BEAM.goesOn)})`, COLORS.goesOn, BEAM.goesOn]],
      text: () => "",
    });
  }
  if (structure.tiles) {
    const { ways, beams, blocks } = structure.tiles;
    const used = WAYS.map((way, i) => [...way, i]).filter((way) => ways.includes(way[2]));
    modes.push({ name: "tiles", title: "tiles, and how their pixels are traced", borders: beams,
      color: (ray) => WAYS[ways[ray]][1], legend: used.map(([title, color]) => [title, color]),
      text: (ray) => `${WAYS[ways[ray]][0]}, tile ${beams[ray]}` });
    modes.push({ name: "blocks", title: "blocks of rays", borders: beams,
      color: (ray) => (ways[ray] < 2 ? WAYS[ways[ray]][1] : numberedColor(blocks[ray])),
      legend: [["each color is a block; lines divide the tiles", "conic-gradient(#d55e00, #009e73, #0072b2, #d55e00)"]],
      text: (ray) => `block ${blocks[ray]} of tile ${beams[ray]}` });
  }
  for (const pencil of structure.pencils) {
    const place = new Int32Array(rays).fill(-1);
    pencil.pixels.forEach((pixel, i) => { place[pixel] = i; });
    const base = { pencil, place, text: (ray) => (place[ray] < 0 ? "no shadow ray" : `block ${pencil.blocks[place[ray]]} of part ${pencil.beams[place[ray]]}, side ${SIDES[pencil.sides[place[ray]]]}`) };
    const sides = SIDES.map((side, i) => [`side ${side}`, SIDE_COLORS[i], i]).filter(([, , i]) => pencil.sides.includes(i));
    modes.push({ ...base, name: `pencil${pencil.light + 1}`, title: `pencil of light ${pencil.light + 1}: sides of its cube`,
      color: (ray) => (place[ray] < 0 ? "#00000000" : SIDE_COLORS[pencil.sides[place[ray]]]), legend: sides });
    modes.push({ ...base, name: `pencil${pencil.light + 1}-blocks`, title: `pencil of light ${pencil.light + 1}: blocks of shadow rays`,
      color: (ray) => (place[ray] < 0 ? "#00000000" : numberedColor(pencil.blocks[place[ray]])),
      legend: [["each color is a block", "conic-gradient(#d55e00, #009e73, #0072b2, #d55e00)"]] });
  }
  const total = work.steps.map((steps, i) => steps + work.passed[i]);
  if (total.some((steps) => steps > 0)) {
    modes.push(rampMode("steps", "steps per pixel", total, "steps"));
    modes.push(rampMode("tests", "ray-primitive tests per pixel", work.tests, "tests"));
  }
  modes.push(rampMode("depth", "depth of the hit", structure.hits.t, "deep"));
  return modes;
}

class ImageMap {
  /** `select(x, y)` is called for a pixel that the user picks. */
  constructor(holder, image, modes, select) {
    this.image = image;
    this.modes = modes;
    this.mode = modes[0];
    this.scale = Math.max(1, Math.round(768 / Math.max(image.width, image.height)));
    this.choice = make("select", { "aria-label": "what the map shows" });
    for (const mode of modes) this.choice.append(make("option", { value: mode.name }, `Map: ${mode.title}`));
    this.canvas = make("canvas", { width: image.width * this.scale, height: image.height * this.scale, tabIndex: 0,
      role: "img", "aria-label": "map of the image" });
    this.legend = make("ul", { class: "legend" });
    this.value = make("span", { class: "note" });
    holder.append(this.choice, this.canvas, this.legend, this.value);
    this.choice.addEventListener("change", () => this.show(this.choice.value));
    this.canvas.addEventListener("pointerdown", (event) => {
      const box = this.canvas.getBoundingClientRect();
      select(Math.floor(((event.clientX - box.left) / box.width) * image.width),
        Math.floor(((event.clientY - box.top) / box.height) * image.height));
    });
    const moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    this.canvas.addEventListener("keydown", (event) => {
      const move = moves[event.key];
      if (!move) return;
      event.preventDefault();
      event.stopPropagation();
      select(this.x + move[0], this.y + move[1]);
    });
    this.onchange = () => {};
  }

  show(name) {
    this.mode = this.modes.find((mode) => mode.name === name) ?? this.modes[0];
    this.choice.value = this.mode.name;
    this.ground = this.#paint();
    this.legend.replaceChildren(...this.mode.legend.map((entry) => this.#legendItem(entry)));
    this.#draw();
    this.onchange();
  }

  /** Returns a color with its meaning; beams can be hidden by kind. */
  #legendItem([title, color, kind]) {
    const item = make("li");
    const sign = make("i", { class: color.startsWith("linear") ? "ramp" : "", style: `background:${color}` });
    const { shown } = this.mode;
    if (!shown) {
      item.append(sign, title);
      return item;
    }
    const box = make("input", { type: "checkbox", checked: shown.has(kind) });
    box.addEventListener("change", () => this.showKinds(kind, box.checked));
    const label = make("label");
    label.append(box, sign, title);
    item.append(label);
    return item;
  }

  showKinds(kind, wanted) {
    if (wanted) this.mode.shown.add(kind);
    else this.mode.shown.delete(kind);
    this.show(this.mode.name);
  }

  select(x, y) {
    [this.x, this.y] = [x, y];
    this.#draw();
  }

  #paint() {
    const { image: { width, height }, scale, mode } = this;
    const canvas = make("canvas", { width: width * scale, height: height * scale });
    const pen = canvas.getContext("2d");
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        pen.fillStyle = mode.color(y * width + x);
        pen.fillRect(x * scale, y * scale, scale, scale);
      }
    }
    if (mode.outlines) this.#paintOutlines(pen, mode.outlines, mode.shown);
    if (mode.borders) this.#paintBorders(pen, mode.borders);
    return canvas;
  }

  #paintOutlines(pen, { kinds, first, corners }, shown) {
    const outline = (beam) => {
      pen.beginPath();
      for (let i = first[beam]; i < first[beam + 1]; ++i) pen.lineTo(corners[2 * i] * this.scale, corners[2 * i + 1] * this.scale);
      pen.closePath();
    };
    const colors = [COLORS.goesOn, COLORS.occupied, COLORS.leaves];
    for (const kind of [BEAM.leaves, BEAM.occupied].filter((each) => shown.has(each))) {
      pen.fillStyle = colors[kind];
      for (let beam = 0; beam < kinds.length; ++beam) {
        if (kinds[beam] !== kind) continue;
        outline(beam);
        pen.globalAlpha = 0.55;
        pen.fill();
        pen.globalAlpha = 1;
      }
    }
    pen.lineWidth = 1;
    for (const kind of [BEAM.goesOn, BEAM.leaves, BEAM.occupied].filter((each) => shown.has(each))) {
      pen.strokeStyle = colors[kind];
      for (let beam = 0; beam < kinds.length; ++beam) {
        if (kinds[beam] !== kind) continue;
        outline(beam);
        pen.stroke();
      }
    }
  }

  #paintBorders(pen, beams) {
    const { image: { width, height }, scale } = this;
    pen.fillStyle = "#10141a";
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        const beam = beams[y * width + x];
        if (x > 0 && beams[y * width + x - 1] !== beam) pen.fillRect(x * scale, y * scale, 1, scale);
        if (y > 0 && beams[(y - 1) * width + x] !== beam) pen.fillRect(x * scale, y * scale, scale, 1);
      }
    }
  }

  #draw() {
    const pen = this.canvas.getContext("2d");
    pen.fillStyle = "#1d2127";
    pen.fillRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.ground, 0, 0);
    if (this.x === undefined) return;
    const { scale } = this;
    for (const [color, grow] of [["#000000", 3], ["#ffffff", 1.5]]) {
      pen.strokeStyle = color;
      pen.lineWidth = 2;
      pen.strokeRect(this.x * scale - grow, this.y * scale - grow, scale + 2 * grow, scale + 2 * grow);
    }
    const said = this.mode.text(this.y * this.image.width + this.x);
    this.value.textContent = `Pixel (${this.x}, ${this.y})${said ? `: ${said}` : ""}`;
  }
}
