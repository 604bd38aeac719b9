// Puts the page together.

function make(tag, attributes = {}, text = "") {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name in element && name !== "class" && name !== "style" && name !== "role") element[name] = value;
    else if (value !== "") element.setAttribute(name, value);
  }
  if (text) element.textContent = text;
  return element;
}

/** One structure: its stage, its map, and the steps of the selected ray. */
class StructurePanel {
  constructor(data, structure, work, shared, select) {
    this.data = data;
    this.structure = structure;
    this.work = work;
    this.section = make("section", { class: "structure", "aria-label": structure.label });
    const head = make("div", { class: "head" });
    head.append(make("h2", {}, structure.label), make("span", { class: "note" }, factsOf(structure)));
    const view = make("div", { class: "view" });
    const stage = make("div", { class: "stage" });
    this.map = new ImageMap(this.#mapHolder = make("div", { class: "map" }), data.image, mapModes(data, structure, work), select);
    try {
      this.stage = new Stage(stage, shared, structure);
      this.stage.lights = data.scene.lights;
    } catch (error) {
      stage.append(make("p", { class: "message" }, "This browser cannot show the scene in 3D (WebGL is off). The map and the steps work without it."));
    }
    view.append(stage, this.#viewControls(shared));
    this.section.append(head, view, this.#mapHolder, this.#stepHolder());
    this.map.onchange = () => this.#showMap();
  }
  #mapHolder;

  #viewControls(shared) {
    const controls = make("div", { class: "controls", style: "margin-top:8px" });
    const outside = make("button", { type: "button" }, "View from outside");
    const eye = make("button", { type: "button" }, "View from the eye");
    outside.addEventListener("click", () => shared?.lookFromOutside());
    eye.addEventListener("click", () => shared?.lookFromEye());
    const levels = this.structure.cells.levels;
    this.last = levels.reduce((a, b) => Math.max(a, b), 0);
    this.level = make("input", { type: "range", min: 0, max: this.last + 1, value: 0 });
    this.levelText = make("span", { class: "note" });
    const label = make("label", {}, "Level ");
    label.append(this.level, this.levelText);
    this.level.addEventListener("input", () => this.showLevel(Number(this.level.value)));
    const surface = make("input", { type: "range", min: 0, max: 100, value: 100 * START_OPACITY });
    const surfaceLabel = make("label", {}, "Surfaces ");
    surfaceLabel.append(surface);
    surface.addEventListener("input", () => {
      if (!shared) return;
      setOpacity(shared, surface.value / 100);
    });
    this.inScene = make("input", { type: "checkbox" });
    const inSceneLabel = make("label");
    inSceneLabel.append(this.inScene, "Map in the scene");
    this.inScene.addEventListener("change", () => this.#showMap());
    controls.append(outside, eye, label, surfaceLabel, inSceneLabel);
    return controls;
  }

  #stepHolder() {
    const holder = make("div", { class: "steps" });
    const controls = make("div", { class: "controls" });
    this.back = make("button", { type: "button", "aria-label": "step back" }, "\u25c0 Back");
    this.forward = make("button", { type: "button", "aria-label": "step forward" }, "Forward \u25b6");
    this.play = make("button", { type: "button" }, "Play");
    this.place = make("input", { type: "range", min: 0, "aria-label": "step of the ray" });
    this.text = make("div", { class: "step", "aria-live": "polite" });
    this.back.addEventListener("click", () => this.go(this.at - 1));
    this.forward.addEventListener("click", () => this.go(this.at + 1));
    this.play.addEventListener("click", () => this.#toggle());
    this.place.addEventListener("input", () => this.go(Number(this.place.value)));
    controls.append(this.back, this.forward, this.play);
    holder.append(controls, this.place, this.text);
    return holder;
  }

  #toggle() {
    if (this.timer) return this.#stop();
    if (this.at >= this.steps.length - 1) this.go(0);
    this.play.textContent = "Pause";
    this.timer = setInterval(() => (this.at < this.steps.length - 1 ? this.go(this.at + 1) : this.#stop()), 700);
  }
  #stop() {
    clearInterval(this.timer);
    this.timer = undefined;
    this.play.textContent = "Play";
  }

  showLevel(level) {
    const { cells } = this.structure;
    const count = cells.levels.filter((each) => each === level || level > this.last).length;
    this.level.value = level;
    this.levelText.textContent = level === 0 ? "no cells" : level > this.last ? `all: ${number(count)} ${cells.kind}` : `${level}: ${number(count)} ${cells.kind}`;
    this.stage?.showLevel(level, this.last);
  }

  #showMap() {
    this.stage?.showMap(this.map.mode, this.inScene.checked);
    if (this.pixel) this.go(this.at);
  }

  select(x, y) {
    this.#stop();
    const ray = y * this.data.image.width + x;
    const primitive = this.structure.hits.primitives[ray];
    this.pixel = { x, y, hit: primitive !== NO_PRIMITIVE, primitive, t: this.structure.hits.t[ray] };
    this.steps = stepsOf(this.structure, ray);
    this.map.select(x, y);
    this.go(this.steps.length - 1);
  }

  go(at) {
    const last = Math.max(this.steps.length - 1, 0);
    this.at = Math.min(Math.max(at, 0), last);
    this.place.max = last;
    this.place.value = this.at;
    this.back.disabled = this.at === 0;
    this.forward.disabled = this.at === last;
    this.play.disabled = last === 0;
    const step = this.steps[this.at];
    const end = this.pixel.hit
      ? `The ray hits primitive ${number(this.pixel.primitive)} at t = ${coordinate(this.pixel.t)}.`
      : "The ray hits nothing.";
    const kind = step?.beam ? "a beam that contains the pixel" : "the ray";
    this.text.replaceChildren(
      make("h3", {}, step ? `Step ${this.at + 1} of ${this.steps.length}: ${kind}` : "No steps are recorded for this ray"),
      ...(step ? linesOf(step) : []).map(([line, style]) => make("p", { class: style ?? "" }, line)),
      make("p", { class: "note" }, end));
    this.stage?.showRay(this.pixel, this.steps, this.at, this.map.mode);
  }
}

const START_OPACITY = 0.6;

function setOpacity(shared, opacity) {
  shared.surfaces.material.opacity = opacity;
  shared.surfaces.material.visible = opacity > 0;
  shared.surfaces.material.depthWrite = opacity > 0.95;
  shared.draw();
}

/** Returns the pixel whose ray is shown first: the one with the most work. */
function busiest(data, work) {
  let best = 0;
  work.steps.forEach((steps, ray) => {
    const cost = (each) => work.steps[each] + work.passed[each];
    if (data.structures[0].hits.primitives[ray] !== NO_PRIMITIVE && cost(ray) > cost(best)) best = ray;
  });
  return best;
}

async function start() {
  const data = await readData();
  const labels = data.structures.map((structure) => structure.label);
  document.title = `${data.scene.name} by ${labels.join(" and ")}`;
  document.getElementById("title").textContent = document.title;
  const works = data.structures.map(countWork);
  document.getElementById("sentence").textContent = comparison(data.structures, works);
  document.getElementById("notes").textContent = notesOf(data);
  let shared = null;
  try {
    shared = new SharedView(data);
    setOpacity(shared, START_OPACITY);
  } catch (error) {
    console.warn(error.message);
  }
  const { width, height } = data.image;
  const panels = [];
  const select = (x, y) => {
    if (x < 0 || y < 0 || x >= width || y >= height) return;
    for (const panel of panels) panel.select(x, y);
  };
  const main = document.getElementById("structures");
  main.replaceChildren();
  main.className = data.structures.length === 1 ? "one" : "two";
  data.structures.forEach((structure, i) => {
    const panel = new StructurePanel(data, structure, works[i], shared, select);
    panels.push(panel);
    main.append(panel.section);
  });
  const asked = new URLSearchParams(location.hash.slice(1));
  for (const panel of panels) {
    const { levels } = panel.structure.cells;
    const only = asked.get("only");  // a kind of beams
    if (only !== null) for (const kind of Object.values(BEAM)) panel.map.modes[0].shown?.[kind === Number(only) ? "add" : "delete"](kind);
    panel.inScene.checked = asked.has("scene");
    panel.map.show(asked.get("map"));
    const level = asked.get("level") ?? (levels.length <= 2500 ? "all" : "0");
    panel.showLevel(level === "all" ? panel.last + 1 : Number(level));
  }
  const first = busiest(data, works[0]);
  const [x, y] = (asked.get("pixel") ?? `${first % width},${Math.floor(first / width)}`).split(",").map(Number);
  select(x, y);
  if (asked.get("view") === "eye") shared?.lookFromEye();
  document.addEventListener("keydown", (event) => {
    if (/INPUT|SELECT|CANVAS/.test(event.target.tagName)) return;
    if (event.key === "ArrowRight") for (const panel of panels) panel.go(panel.at + 1);
    if (event.key === "ArrowLeft") for (const panel of panels) panel.go(panel.at - 1);
  });
  document.body.dataset.ready = "yes";
}

start();
