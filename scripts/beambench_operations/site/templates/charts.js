// The chart of one view at one resolution: ratios run by run, as SVG with links and hover titles.
// Only the selected chart is unpacked and drawn.
(() => {
  const data = JSON.parse(document.getElementById("chart-data").textContent);
  const form = document.getElementById("pick");
  const figure = document.getElementById("series");
  const legend = document.getElementById("legend");
  const dashes = ["", "7 4", "2 4", "9 3 2 3"];
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const margin = { left: 54, right: 14, top: 12, bottom: 52 };

  const make = (name, attributes = {}, ...children) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
  };

  const unpack = (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    return Array.from({ length: bytes.length / 2 }, (_, place) => {
      const whole = view.getInt16(2 * place, true);
      return whole === data.missing ? null : Math.exp(whole / data.step);
    });
  };

  // Black and the other dark colors of the plots are lightened on a dark background.
  const shown = (color) => {
    if (!dark.matches) return color;
    const parts = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
    const light = 0.3 * parts[0] + 0.59 * parts[1] + 0.11 * parts[2];
    const lift = light < 110 ? 0.55 - light / 300 : 0;
    return `rgb(${parts.map((part) => Math.round(part + (255 - part) * lift)).join(",")})`;
  };

  // Ticks of a logarithmic axis: 1, 2 and 5 in each decade, or even steps if the range is small.
  const ticksOf = (low, high) => {
    const found = [];
    if (high / low > 4) {
      for (let decade = Math.floor(Math.log10(low)); decade <= Math.log10(high); ++decade)
        for (const digit of [1, 2, 5]) found.push(digit * 10 ** decade);
    } else {
      const rough = (high - low) / 5;
      const power = 10 ** Math.floor(Math.log10(rough));
      const step = power * ([1, 2, 5].find((digit) => digit * power >= rough) ?? 10);
      for (let tick = Math.ceil(low / step); tick <= high / step; ++tick) found.push(tick * step);
    }
    return found.filter((tick) => tick >= low && tick <= high);
  };
  const inWords = (value) => String(Number(value.toPrecision(4)));

  const draw = () => {
    const { view, size, contender } = form.elements;
    const lines = data.views[view.value][size.value]
      .filter((cell) => cell.verdict !== "baseline")
      .filter((cell) => contender.value === "" || cell.name === contender.value)
      .map((cell) => ({ ...cell, values: unpack(cell.ratios) }))
      .filter((line) => line.values.some((value) => value !== null));
    figure.setAttribute("aria-label", `Ratios to Embree, run by run, in ${view.value} at ${size.value}`);
    legend.replaceChildren(...lines.map(entry));
    if (lines.length === 0) {
      figure.textContent = "No time in this view has a reference in the same run.";
      return;
    }
    const width = Math.max(280, Math.min(1040, figure.clientWidth));
    const height = Math.round(Math.max(300, Math.min(520, 0.55 * width)));
    const values = lines.flatMap((line) => line.values).filter((value) => value !== null);
    const low = Math.min(...values) / 1.02;
    const high = Math.max(...values) * 1.02;
    const across = width - margin.left - margin.right;
    const down = height - margin.top - margin.bottom;
    const count = data.nights.length;
    const x = (place) => margin.left + (count === 1 ? 0.5 : place / (count - 1)) * across;
    const y = (value) => margin.top + (Math.log(high / value) / Math.log(high / low)) * down;
    const picture = make("svg", { viewBox: `0 0 ${width} ${height}`, width, height });
    for (const tick of ticksOf(low, high)) {
      picture.append(make("line", { class: "grid", x1: margin.left, x2: width - margin.right, y1: y(tick), y2: y(tick) }));
      picture.append(make("text", { x: margin.left - 6, y: y(tick) + 4, "text-anchor": "end" }, inWords(tick)));
    }
    for (const place of data.alarms) {
      picture.append(make("line", { class: "alarm", x1: x(place), x2: x(place), y1: margin.top, y2: margin.top + down }));
    }
    picture.append(...dates(x, across, height), ...changes(x, margin.top + down + 10));
    for (const line of lines) picture.append(curve(line, x, y), ...points(line, x, y));
    figure.replaceChildren(picture);
  };

  const dates = (x, across, height) => {
    const count = data.nights.length;
    const every = Math.max(1, Math.ceil(count / Math.max(1, Math.floor(across / 92))));
    const days = new Set(data.nights.map((night) => night.time.slice(0, 10)));
    const found = [];
    for (let place = 0; place < count; place += every) {
      const time = data.nights[place].time;
      const text = days.size > 1 ? time.slice(0, 10) : time.slice(11, 16);
      const anchor = place === count - 1 ? "end" : "middle";
      found.push(make("text", { x: x(place), y: height - 18, "text-anchor": anchor }, text));
    }
    return found;
  };

  const link = (href, label, ...children) =>
    make("a", { href, tabindex: -1, "aria-label": label }, ...children, make("title", {}, label));

  const changes = (x, y) =>
    data.nights.flatMap((night, place) => {
      if (!night.change) return [];
      const mark = make("path", { class: "commit", d: `M${(x(place - 1) + x(place)) / 2} ${y - 6}l5 6l-5 6l-5-6z` });
      return [link(night.change, `Change to ${night.commit}\n${night.subject}`, mark)];
    });

  const curve = (line, x, y) => {
    let path = "";
    let open = false;
    line.values.forEach((value, place) => {
      // Nights that are not compared are not connected.
      if (data.nights[place].in_blocks !== data.nights[place - 1]?.in_blocks) open = false;
      if (value !== null) path += `${open ? "L" : "M"}${x(place).toFixed(1)} ${y(value).toFixed(1)}`;
      open = value !== null;
    });
    return make("path", { d: path, fill: "none", stroke: shown(line.color), "stroke-width": 1.7, "stroke-dasharray": dashes[line.variant % dashes.length] });
  };

  const points = (line, x, y) =>
    line.values.flatMap((value, place) => {
      if (value === null) return [];
      const night = data.nights[place];
      const how = night.in_blocks ? "" : " (not measured in blocks: not compared)";
      const words = `${line.name}: ${inWords(value)} × Embree${how}\n${night.run}\ncommit ${night.commit} ${night.subject}`;
      const color = shown(line.color);
      const paint = night.in_blocks ? { fill: color } : { fill: "none", stroke: color };
      const dot = make("circle", { cx: x(place).toFixed(1), cy: y(value).toFixed(1), r: data.nights.length > 60 ? 2.5 : 4, ...paint });
      return [night.href ? link(night.href, words, dot) : make("g", {}, dot, make("title", {}, words))];
    });

  const entry = (line) => {
    const item = document.createElement("li");
    const stroke = { stroke: shown(line.color), "stroke-width": 2, "stroke-dasharray": dashes[line.variant % dashes.length] };
    item.append(
      make("svg", { width: 34, height: 10, "aria-hidden": "true" },
        make("line", { x1: 0, x2: 34, y1: 5, y2: 5, ...stroke }),
        make("circle", { cx: 17, cy: 5, r: 3.5, fill: shown(line.color) })),
      line.name);
    return item;
  };

  const fill = (select, names, words = names) => {
    const wanted = select.value;
    select.replaceChildren(...names.map((name, place) => new Option(words[place], name)));
    if (names.includes(wanted)) select.value = wanted;
  };
  const fillAll = () => {
    const { view, size, contender } = form.elements;
    fill(view, Object.keys(data.views));
    const sizes = Object.keys(data.views[view.value]);
    const chosen = size.value;
    fill(size, sizes);
    if (!sizes.includes(chosen)) size.value = sizes[sizes.length - 1];
    const names = data.views[view.value][size.value].filter((cell) => cell.verdict !== "baseline").map((cell) => cell.name);
    fill(contender, ["", ...names], ["all", ...names]);
  };

  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", () => {
    fillAll();
    draw();
  });
  form.hidden = false;
  fillAll();
  draw();
  dark.addEventListener("change", draw);
  addEventListener("resize", draw);
})();
