// Compares any two runs of a sweep, by the rules of site/comparison.py.
(() => {
  const runs = JSON.parse(document.getElementById("runs-data").textContent);
  const form = document.getElementById("two");
  const table = document.getElementById("any-table");
  const status = document.getElementById("status");
  const loaded = new Map();
  const waiting = new Map();
  let made = null;
  window.beambench = {
    add: (run) => {
      loaded.set(run.name, run);
      waiting.get(run.name)?.();
    },
  };

  const load = (name) =>
    loaded.has(name)
      ? Promise.resolve()
      : new Promise((resolve) => {
          waiting.set(name, resolve);
          const script = document.createElement("script");
          script.src = `../runs/${encodeURIComponent(name)}/data.js`;
          script.onerror = () => (status.textContent = `The data of ${name} cannot be loaded.`);
          document.head.append(script);
        });

  const [KEY, VIEW, SIZE, CONTENDER, VERDICT, INPUTS, , MS, RATIO] = Array(9).keys();
  const differ = (a, b) =>
    String(a.machine_ids) !== String(b.machine_ids) ||
    Boolean(a.processor && b.processor && a.processor !== b.processor);

  // Distances to the ends add up in quadrature, on a logarithmic scale, as in harness/analysis/ratio.cpp.
  const change = (before, after) => {
    if (!before || !after) return null;
    const value = after[0] / before[0];
    if ([...before, ...after].some((end) => end === null)) return [value, null, null];
    const down = Math.hypot(Math.log(after[0] / after[1]), Math.log(before[2] / before[0]));
    const up = Math.hypot(Math.log(after[2] / after[0]), Math.log(before[0] / before[1]));
    return [value, value * Math.exp(-down), value * Math.exp(up)];
  };

  const parts = (cell) => cell[KEY].split(" | ");
  const who = (cell) => parts(cell).slice(2, 4).join(" ");
  const raysOf = (cell) => parts(cell).filter((_, place) => place < 2 || place > 3).join(" | ");
  const over = (reference, run) => {
    const bases = new Map(run.cells.filter((cell) => who(cell) === reference).map((cell) => [raysOf(cell), cell[MS]]));
    return new Map(run.cells.map((cell) => [cell[KEY], change(bases.get(raysOf(cell)), cell[MS])]));
  };
  const ratios = (before, after) => {
    if (before.reference === after.reference && after.reference !== "")
      return [after.reference, [before, after].map((run) => new Map(run.cells.map((cell) => [cell[KEY], cell[RATIO]])))];
    const timed = new Set(before.cells.filter((cell) => cell[MS]).map((cell) => cell[KEY]));
    const common = new Map();
    for (const cell of after.cells)
      if (cell[MS] && timed.has(cell[KEY]) && cell[VERDICT] !== "baseline") common.set(who(cell), (common.get(who(cell)) ?? 0) + 1);
    const single = (name) => Number(name.startsWith("embree ") && name.includes("mode=single"));
    const [reference = ""] = [...common.keys()].sort(
      (a, b) => single(b) - single(a) || common.get(b) - common.get(a) || (a < b ? 1 : -1));
    return [reference, [before, after].map((run) => over(reference, run))];
  };

  const percent = (ratio) => `${ratio >= 1 ? "+" : ""}${(100 * (ratio - 1)).toFixed(1)}%`;
  const figure = (ends, inWords, side = "") => {
    const cell = document.createElement("td");
    cell.className = `figure ${side}`;
    cell.dataset.order = ends ? ends[0] : "";
    cell.textContent = ends ? inWords(ends[0]) : "–";
    if (ends && ends[1] !== null && ends[2] !== null) {
      const small = document.createElement("small");
      small.textContent = `${inWords(ends[1])} to ${inWords(ends[2])}`;
      cell.append(small);
    }
    return cell;
  };
  const text = (kind, words) => {
    const cell = document.createElement(kind);
    cell.textContent = words;
    if (kind === "th") cell.scope = "row";
    return cell;
  };
  const format = new Intl.NumberFormat("en", { maximumSignificantDigits: 4 });
  const plain = (value) => format.format(value);

  const show = async () => {
    const [one, two] = [form.elements.before.value, form.elements.after.value];
    await Promise.all([load(one), load(two)]);
    if (one !== form.elements.before.value || two !== form.elements.after.value) return;
    const [before, after] = [loaded.get(one), loaded.get(two)];
    const apart = differ(before, after);
    made?.destroy();
    made = null;
    if (before.in_blocks !== after.in_blocks) {
      document.getElementById("warning").hidden = true;
      status.textContent = "One of these runs was not measured in blocks: its times are medians, which are not compared.";
      table.tBodies[0].replaceChildren();
      return;
    }
    const [reference, [thenRatios, nowRatios]] = ratios(before, after);
    const known = new Map(before.cells.map((cell) => [cell[KEY], cell]));
    const pairs = after.cells
      .filter((cell) => known.get(cell[KEY])?.[INPUTS] === cell[INPUTS])
      .map((cell) => {
        const key = cell[KEY];
        const leaveOut = cell[VERDICT] === "baseline" || who(cell) === reference;
        const both = leaveOut ? [null, null] : [thenRatios.get(key), nowRatios.get(key)];
        return { then: known.get(key), cell, both, ratio: change(...both) };
      });
    pairs.sort((a, b) => Math.abs((b.ratio?.[0] ?? 1) - 1) - Math.abs((a.ratio?.[0] ?? 1) - 1));
    const side = (ratio) => (ratio?.[1] > 1 ? "slower" : ratio?.[2] !== null && ratio?.[2] < 1 ? "faster" : "");
    const count = (wanted) => pairs.filter((pair) => side(pair.ratio) === wanted).length;
    const label = after.cells.find((cell) => who(cell) === reference)?.[CONTENDER] ?? "no common reference";
    document.getElementById("warning").hidden = !apart;
    status.textContent =
      `Of ${pairs.filter((pair) => pair.ratio).length} ratios to ${label}, ` +
      `${count("slower")} are higher (slower) and ${count("faster")} lower (faster) by their intervals.`;
    const heads = ["contender", "view", "ratio before", "after", "change"];
    if (!apart) heads.push("ms before", "after", "change");
    const head = document.createElement("tr");
    head.append(...heads.map((words, place) => {
      const cell = text("th", words);
      cell.scope = "col";
      if (place > 1) cell.className = "figure";
      return cell;
    }));
    table.tHead.replaceChildren(head);
    table.tBodies[0].replaceChildren(...pairs.map(({ then, cell, both, ratio }) => {
      const row = document.createElement("tr");
      const view = text("td", cell[VIEW]);
      const size = document.createElement("small");
      size.textContent = cell[SIZE];
      view.append(size);
      row.append(text("th", cell[CONTENDER]), view);
      row.append(figure(both[0], plain), figure(both[1], plain), figure(ratio, percent, side(ratio)));
      if (!apart) row.append(figure(then[MS], plain), figure(cell[MS], plain), figure(change(then[MS], cell[MS]), percent));
      return row;
    }));
    if (window.DataTable) made = makeSortable(table);
  };

  const fill = () => {
    const { sweep, before, after } = form.elements;
    const own = runs.filter((run) => run.sweep === sweep.value);
    for (const [select, place] of [[before, own.length - 2], [after, own.length - 1]]) {
      select.replaceChildren(...own.map((run) => new Option(`${run.date}, ${run.machine}, ${run.commit}`, run.name)));
      select.selectedIndex = Math.max(0, place);
    }
  };
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", (event) => {
    if (event.target.name === "sweep") fill();
    show();
  });
  const counts = new Map();
  for (const run of runs) counts.set(run.sweep, (counts.get(run.sweep) ?? 0) + 1);
  const sweeps = [...counts.keys()].filter((name) => counts.get(name) > 1);
  if (sweeps.length === 0) {
    status.textContent = "No sweep has two runs.";
    return;
  }
  form.elements.sweep.replaceChildren(...sweeps.map((name) => new Option(name, name)));
  form.hidden = false;
  fill();
  show();
})();
