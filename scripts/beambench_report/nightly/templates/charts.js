"use strict";

// The charts of one view at one resolution, drawn by Plotly: ratios night by night, and build
// against trace time of the last night. Only what is looked at is unpacked and drawn.
(() => {
  const data = JSON.parse(document.getElementById("chart-data").textContent);
  const form = document.getElementById("pick");
  const [series, scatter] = ["series", "scatter"].map((name) => document.getElementById(name));
  const dashes = ["solid", "dash", "dashdot", "dot"];
  const symbols = ["circle", "square", "diamond", "triangle-up", "triangle-down", "cross", "x"];
  const dark = matchMedia("(prefers-color-scheme: dark)");

  const unpack = (text) => {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const view = new DataView(bytes.buffer);
    return Array.from({ length: bytes.length / 2 }, (_, place) => {
      const whole = view.getInt16(2 * place, true);
      return whole === data.missing ? null : Math.exp(whole / data.step);
    });
  };

  // Black and the other dark colors of the house are turned around on dark paper.
  const shown = (color) => {
    if (!dark.matches) return color;
    const parts = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));
    const light = 0.3 * parts[0] + 0.59 * parts[1] + 0.11 * parts[2];
    const lift = light < 110 ? 0.55 - light / 300 : 0;
    return `rgb(${parts.map((part) => Math.round(part + (255 - part) * lift)).join(",")})`;
  };

  const layout = (changes) => {
    const style = getComputedStyle(document.documentElement);
    const value = (name) => style.getPropertyValue(name).trim();
    const axis = { gridcolor: value("--line"), zerolinecolor: value("--line"), automargin: true };
    const { xaxis, yaxis, ...others } = changes;
    return {
      paper_bgcolor: "rgba(0,0,0,0)",
      plot_bgcolor: "rgba(0,0,0,0)",
      font: { color: value("--ink"), family: "system-ui, sans-serif", size: 13 },
      hoverlabel: { bgcolor: value("--card"), font: { color: value("--ink") } },
      margin: { l: 60, r: 20, t: 28, b: 110 },
      legend: { orientation: "h", yref: "container", y: 0, yanchor: "bottom" },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: value("--soft"), activecolor: value("--ink") },
      xaxis: { ...axis, ...xaxis },
      yaxis: { ...axis, ...yaxis },
      ...others,
    };
  };
  const options = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["select2d", "lasso2d"] };

  const drawSeries = (cells) => {
    const times = data.nights.map((night) => night.time);
    const words = data.nights.map((night) => `${night.run}<br>commit ${night.commit}`);
    const lines = cells
      .filter((cell) => cell.verdict !== "baseline")
      .map((cell) => ({
        type: "scatter",
        mode: times.length > 60 ? "lines" : "lines+markers",
        name: cell.name,
        x: times,
        y: unpack(cell.ratios),
        text: words,
        hovertemplate: "%{y:.4g} × Embree<br>%{text}<extra>%{fullData.name}</extra>",
        line: { color: shown(cell.color), dash: dashes[cell.variant % dashes.length], width: 1.7 },
      }));
    const marks = data.alarms.map((place) => ({
      type: "line",
      x0: times[place],
      x1: times[place],
      yref: "paper",
      y0: 0,
      y1: 1,
      line: { color: "#b0382c", width: 1, dash: "dot" },
    }));
    const axes = {
      xaxis: { title: { text: "night (dotted: one that raised an alarm)" }, type: "date" },
      yaxis: { title: { text: "total, over Embree's" }, type: "log", dtick: "D1" },
      shapes: marks,
    };
    return Plotly.react(series, lines, layout(axes), options);
  };

  const drawScatter = (cells) => {
    const right = cells.filter((cell) => cell.verdict === "ok" && cell.build > 0 && cell.trace > 0);
    const points = right.map((cell) => ({
      type: "scatter",
      mode: "markers",
      name: cell.name,
      x: [cell.build],
      y: [cell.trace],
      hovertemplate: "build %{x:.4g} ms<br>trace %{y:.4g} ms<extra>%{fullData.name}</extra>",
      marker: {
        color: shown(cell.color),
        size: 12,
        symbol: symbols[cell.variant % symbols.length] + (cell.front ? "" : "-open"),
        line: { color: shown(cell.color), width: 2 },
      },
    }));
    const front = right.filter((cell) => cell.front).sort((a, b) => a.build - b.build);
    points.unshift({
      type: "scatter",
      mode: "lines",
      name: "Pareto front",
      x: front.map((cell) => cell.build),
      y: front.map((cell) => cell.trace),
      hoverinfo: "skip",
      line: { shape: "hv", color: shown("#777777"), width: 1.5, dash: "dot" },
    });
    const axes = {
      xaxis: { title: { text: "build, ms" }, type: "log" },
      yaxis: { title: { text: "trace, ms" }, type: "log" },
    };
    return Plotly.react(scatter, points, layout(axes), options);
  };

  const summary = (view, size, cells) => {
    const names = cells.filter((cell) => cell.front).map((cell) => cell.name);
    series.setAttribute("aria-label", `Ratios to Embree, night by night, in ${view} at ${size}`);
    scatter.setAttribute("aria-label", `Build against trace time in ${view} at ${size}`);
    document.getElementById("front").textContent =
      names.length === 0 ? "Nothing was verified here." : `On the Pareto front: ${names.join(", ")}.`;
  };

  const draw = () => {
    const view = form.elements.view.value;
    const size = form.elements.size.value;
    const cells = data.views[view][size];
    summary(view, size, cells);
    return Promise.all([drawSeries(cells), drawScatter(cells)]);
  };

  const fill = (select, names) =>
    select.replaceChildren(...names.map((name) => new Option(name, name)));

  const fillSizes = () => {
    const wanted = form.elements.size.value;
    const sizes = Object.keys(data.views[form.elements.view.value]);
    fill(form.elements.size, sizes);
    form.elements.size.value = sizes.includes(wanted) ? wanted : sizes[sizes.length - 1];
  };

  // The table below follows, unless a word of the reader's own stands in its filter.
  let own = "";
  const filterTable = () => {
    const filter = document.querySelector("#cells [name=filter]");
    if (filter.value !== own) return;
    own = form.elements.follow.checked ? form.elements.view.value : "";
    filter.value = own;
    filter.dispatchEvent(new Event("input", { bubbles: true }));
  };

  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("input", (event) => {
    if (event.target.name === "view") fillSizes();
    if (event.target.name !== "size") filterTable();
    draw();
  });
  dark.addEventListener("change", draw);
  fill(form.elements.view, Object.keys(data.views));
  fillSizes();
  form.hidden = false;
  filterTable();
  draw();
})();
