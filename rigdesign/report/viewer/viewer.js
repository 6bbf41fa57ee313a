"use strict";
// Turnable picture of temperature and deformation. The scene stands in the page as JSON, its arrays and the drawing
// library (plotly gl3d) as gzip in base64; nothing is loaded from elsewhere. Without WebGL or DecompressionStream the
// still picture stays.
(() => {
  const root = document.getElementById("viewer");
  const get = (name) => root.querySelector(`[data-part="${name}"]`);
  const scene = JSON.parse(document.getElementById("viewer-scene").textContent);
  const INK = "#22303c", GRID = "#d9dfe4";
  const AXES = ["x", "y", "z"];
  const AXIS_TITLES = ["x along the shafts [mm]", "y across [mm]", "z up [mm]"];
  const VIEWS = {
    start: [-60, 32], front: [180, 4], rear: [0, 4], side: [-90, 4], top: [-90, 85],
  };
  const TURN = 15, NEAREST = 0.6, FARTHEST = 5;
  // Kept side of the plane that turns the cut towards the first view.
  const KEPT = [1, -1, 1];
  const state = { direction: [...VIEWS.start], distance: 1, hidden: new Set() };
  let arrays = null, drawn = null, waiting = false;

  async function unpack(text) {
    const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
    return new Response(stream).arrayBuffer();
  }

  function reader(block) {
    const indices = (at) => at.bytes === 2
      ? new Uint16Array(block, at.start, at.count) : new Uint32Array(block, at.start, at.count);
    const numbers = (at) => Float32Array.from(indices(at), (step) => at.low + step * at.step);
    return { indices, numbers };
  }

  function decode(block) {
    const { indices, numbers } = reader(block);
    const meshes = scene.meshes.map((mesh) => ({
      points: mesh.points.map(numbers),
      tetrahedra: indices(mesh.tetrahedra), tetrahedronBody: indices(mesh.tetrahedron_body),
      vertices: indices(mesh.vertices), triangles: indices(mesh.triangles),
      triangleBody: indices(mesh.triangle_body), triangleSurface: indices(mesh.triangle_surface),
    }));
    const fields = scene.fields.map((field) => {
      const moved = field.displacement.map(numbers);
      return {
        moved, temperature: numbers(field.temperature),
        displacement: Float32Array.from(moved[0], (x, i) => Math.hypot(x, moved[1][i], moved[2][i])),
      };
    });
    return { meshes, fields };
  }

  // Points on the edges between two nodes, each once: number of the node itself, or of a new point of the cut.
  class Points {
    constructor() { this.first = []; this.second = []; this.share = []; this.surface = []; this.known = new Map(); }
    add(first, second, share, surface, key) {
      if (this.known.has(key)) return this.known.get(key);
      this.known.set(key, this.first.length);
      this.first.push(first); this.second.push(second); this.share.push(share); this.surface.push(surface);
      return this.first.length - 1;
    }
  }

  // Skin of one body on the kept side of the plane, and the line in which the plane meets it.
  function skin(mesh, body, height) {
    const points = new Points(), corners = [], outline = [], count = mesh.vertices.length;
    const { vertices, triangles } = mesh;
    for (let t = 0; t < mesh.triangleBody.length; t++) {
      if (mesh.triangleBody[t] !== body) continue;
      const surface = mesh.triangleSurface[t], polygon = [], crossing = [];
      for (let k = 0; k < 3; k++) {
        const a = triangles[3 * t + k], b = triangles[3 * t + (k + 1) % 3];
        const ha = height ? height[vertices[a]] : -1, hb = height ? height[vertices[b]] : -1;
        if (ha < 0) polygon.push(points.add(vertices[a], vertices[a], 0, surface, a));
        if (ha < 0 !== hb < 0) {
          const [low, high, h0, h1] = a < b ? [a, b, ha, hb] : [b, a, hb, ha];
          const place = points.add(vertices[low], vertices[high], h0 / (h0 - h1), surface, count + low * count + high);
          polygon.push(place);
          crossing.push(place);
        }
      }
      for (let k = 2; k < polygon.length; k++) corners.push(polygon[0], polygon[k - 1], polygon[k]);
      if (crossing.length === 2) outline.push(crossing);
    }
    return { points, corners, outline };
  }

  // Face of the cut through one body.
  function face(mesh, body, height) {
    const points = new Points(), corners = [], count = height.length;
    const cells = mesh.tetrahedra;
    const meet = (a, b) => {
      const [low, high] = a < b ? [a, b] : [b, a];
      return points.add(low, high, height[low] / (height[low] - height[high]), -1, low * count + high);
    };
    for (let t = 0; t < mesh.tetrahedronBody.length; t++) {
      if (mesh.tetrahedronBody[t] !== body) continue;
      const below = [], above = [];
      for (let k = 4 * t; k < 4 * t + 4; k++) (height[cells[k]] < 0 ? below : above).push(cells[k]);
      if (!below.length || !above.length) continue;
      if (below.length === 2) {
        const [a, b] = below, [c, d] = above;
        const ring = [meet(a, c), meet(a, d), meet(b, d), meet(b, c)];
        corners.push(ring[0], ring[1], ring[2], ring[0], ring[2], ring[3]);
      } else {
        const [alone, others] = below.length === 1 ? [below[0], above] : [above[0], below];
        corners.push(...others.map((other) => meet(alone, other)));
      }
    }
    return { points, corners };
  }

  function choice() {
    const axis = AXES.indexOf(get("axis").value);
    return {
      number: Number(get("field").value), quantity: get("quantity").value, factor: Number(get("factor").value),
      axis, position: Number(get("position").value), side: (get("side").checked ? -1 : 1) * (KEPT[axis] || 1),
    };
  }

  const said = (value, digits) => value.toLocaleString("en", {
    minimumFractionDigits: digits, maximumFractionDigits: digits, useGrouping: false,
  }).replace("-", "\u2212");

  function trace(found, mesh, field, wanted, names, lighting) {
    const { points, corners } = found, n = points.first.length;
    const between = (values) => Float32Array.from(
      { length: n }, (_, i) => values[points.first[i]] + points.share[i] * (values[points.second[i]] - values[points.first[i]]),
    );
    const moved = field.moved.map(between);
    const at = mesh.points.map(between).map((line, axis) => line.map((x, i) => x + 1e-3 * wanted.factor * moved[axis][i]));
    const temperature = between(field.temperature);
    const size = Float32Array.from(moved[0], (x, i) => Math.hypot(x, moved[1][i], moved[2][i]));
    return {
      type: "mesh3d", x: at[0], y: at[1], z: at[2],
      i: corners.filter((_, k) => k % 3 === 0), j: corners.filter((_, k) => k % 3 === 1), k: corners.filter((_, k) => k % 3 === 2),
      intensity: wanted.quantity === "temperature" ? temperature : size, coloraxis: "coloraxis",
      text: Array.from(temperature, (value, i) => `${names(points.surface[i])}<br>${said(value, 1)} °C, moved ${said(size[i], 0)} µm`),
      hovertemplate: "%{text}<extra></extra>", flatshading: !lighting, showscale: false,
      lighting: lighting || { ambient: 1, diffuse: 0, specular: 0, fresnel: 0 },
      lightposition: { x: -4000, y: -8000, z: 9000 },
    };
  }

  function traces() {
    const wanted = choice(), entry = scene.fields[wanted.number], about = scene.meshes[entry.mesh];
    const mesh = arrays.meshes[entry.mesh], field = arrays.fields[wanted.number];
    const height = wanted.axis < 0 ? null
      : mesh.points[wanted.axis].map((x) => wanted.side * (x - wanted.position) + 1e-5);
    const lines = { x: [], y: [], z: [] }, found = [];
    about.bodies.forEach((name, body) => {
      if (state.hidden.has(body)) return;
      const outside = skin(mesh, body, height);
      const light = { ambient: 0.72, diffuse: 0.42, specular: 0.03, roughness: 0.9, fresnel: 0 };
      const whole = trace(outside, mesh, field, wanted, (surface) => `${name}: ${about.surfaces[surface]}`, light);
      if (outside.corners.length) found.push(whole);
      if (!height) return;
      const inside = face(mesh, body, height);
      if (inside.corners.length) found.push(trace(inside, mesh, field, wanted, () => `${name}, in the cut`, null));
      for (const pair of outside.outline) {
        for (const axis of AXES) lines[axis].push(...pair.map((place) => whole[axis][place]), null);
      }
    });
    if (lines.x.length) {
      found.push({ type: "scatter3d", mode: "lines", ...lines, line: { color: INK, width: 2 }, hoverinfo: "skip", showlegend: false });
    }
    return found;
  }

  // 1 for every node of a body that is shown; all nodes where none is.
  function shownNodes(mesh) {
    const used = new Uint8Array(mesh.points[0].length);
    for (let k = 0; k < mesh.tetrahedra.length; k++) {
      if (!state.hidden.has(mesh.tetrahedronBody[k >> 2])) used[mesh.tetrahedra[k]] = 1;
    }
    return used.includes(1) ? used : used.fill(1);
  }

  // Least and largest of the values of the nodes that are used.
  function extent(values, used) {
    let low = Infinity, high = -Infinity;
    values.forEach((value, i) => {
      if (used[i]) [low, high] = [Math.min(low, value), Math.max(high, value)];
    });
    return [low, high];
  }

  // Ends of the axes [mm]: everything shown as drawn, and as moved by the largest factor of the list.
  function ends() {
    const wanted = choice(), entry = scene.fields[wanted.number], mesh = arrays.meshes[entry.mesh];
    const field = arrays.fields[wanted.number], most = 1e-3 * 2 * entry.factor, used = shownNodes(mesh);
    return mesh.points.map((line, axis) => {
      const drawnEnds = extent(line, used);
      const movedEnds = extent(line.map((x, i) => x + most * field.moved[axis][i]), used);
      return [Math.min(drawnEnds[0], movedEnds[0]), Math.max(drawnEnds[1], movedEnds[1])];
    });
  }

  const startDistance = () => narrow() ? 2.5 : 2.15;
  const narrow = () => get("plot").clientWidth < 560;

  function camera() {
    const [azimuth, elevation] = state.direction.map((angle) => angle * Math.PI / 180), r = state.distance;
    return {
      eye: {
        x: r * Math.cos(elevation) * Math.cos(azimuth), y: r * Math.cos(elevation) * Math.sin(azimuth), z: r * Math.sin(elevation),
      },
      up: { x: 0, y: 0, z: 1 }, center: { x: 0, y: 0, z: narrow() ? -0.1 : -0.13 },
    };
  }

  function layout() {
    const wanted = choice(), range = ends();
    const span = range.map(([low, high]) => high - low), most = Math.max(...span);
    const room = range.map(([low, high], axis) => [low - 0.04 * span[axis], high + 0.04 * span[axis]]);
    const label = wanted.quantity === "temperature" ? "temperature [°C]" : "displacement, size [µm]";
    const [cmin, cmax] = scene.ranges[wanted.quantity];
    const bar = narrow()
      ? { orientation: "h", x: 0.5, y: -0.02, yanchor: "top", len: 0.95, thickness: 11, title: { text: label, side: "top" } }
      : { x: 1, xanchor: "left", len: 0.9, thickness: 14, title: { text: label, side: "right" } };
    const axis = (number) => ({
      title: { text: narrow() ? `${AXES[number]} [mm]` : AXIS_TITLES[number], font: { size: 11 } }, range: room[number], nticks: 5, tickfont: { size: 10 }, hoverformat: ".0f",
      gridcolor: GRID, zeroline: false, showbackground: false, showspikes: false, tickformat: ".0f",
    });
    return {
      autosize: true, margin: { l: 0, r: 0, t: 0, b: narrow() ? 50 : 0 }, showlegend: false, paper_bgcolor: "#fff",
      font: { family: "Segoe UI, Helvetica Neue, Arial, Liberation Sans, sans-serif", size: 12, color: INK },
      coloraxis: { colorscale: scene.colours[wanted.quantity], cmin, cmax, colorbar: { ...bar, outlinewidth: 0, tickfont: { size: 11 } } },
      scene: {
        xaxis: axis(0), yaxis: axis(1), zaxis: axis(2), camera: camera(), dragmode: "turntable",
        aspectmode: "manual", aspectratio: Object.fromEntries(AXES.map((name, k) => [name, 1.3 * span[k] / most])),
      },
      hoverlabel: { bgcolor: "#fff", bordercolor: INK, font: { color: INK, size: 12 } },
    };
  }

  function describe() {
    const wanted = choice(), entry = scene.fields[wanted.number];
    const cut = wanted.axis < 0 ? "no cut" : `cut at ${AXES[wanted.axis]} = ${said(wanted.position, 0)} mm, in the rig as drawn`;
    const shape = wanted.factor ? `displacement drawn ${said(wanted.factor, 0)} times as large` : "shape as drawn";
    get("words").textContent = `Gearbox ${entry.gearbox}, stage ${entry.stage.replaceAll("_", " ")}: ${shape}; ${cut}.`;
    get("place").textContent = wanted.axis < 0 ? "" : `${said(wanted.position, 0)} mm`;
    get("position").disabled = get("side").disabled = wanted.axis < 0;
  }

  function draw() {
    describe();
    if (waiting || !arrays) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      drawn = Plotly.react(get("plot"), traces(), layout(), {
        responsive: true, displaylogo: false, displayModeBar: false, scrollZoom: false,
      });
      drawn.then(count);
    });
  }

  // The slider runs over what is shown, short of its ends, where nothing would be left of it.
  function limitSlider() {
    const wanted = choice();
    if (wanted.axis < 0) return;
    const mesh = arrays.meshes[scene.fields[wanted.number].mesh], slider = get("position");
    const [low, high] = extent(mesh.points[wanted.axis], shownNodes(mesh)), room = 0.02 * (high - low);
    slider.step = high - low > 20 ? 1 : 0.1;
    slider.min = Math.ceil((low + room) / slider.step) * slider.step;
    slider.max = Math.floor((high - room) / slider.step) * slider.step;
  }

  // Its first place is the plane of the shaft axes, else the middle.
  function placeSlider() {
    limitSlider();
    const wanted = choice(), entry = scene.fields[wanted.number], slider = get("position");
    slider.value = wanted.axis === 2 ? scene.meshes[entry.mesh].cut : (Number(slider.min) + Number(slider.max)) / 2;
  }

  function offer(select, options, value) {
    select.replaceChildren(...options.map(([key, text]) => new Option(text, key, false, key === value)));
  }

  function offerField() {
    const entry = scene.fields[Number(get("field").value)], about = scene.meshes[entry.mesh];
    const factors = entry.factor ? [0.5, 1, 2].map((times) => times * entry.factor) : [];
    offer(get("factor"), [["0", "as drawn"], ...factors.map((f) => [String(f), `deformed × ${said(f, f < 1 ? 1 : 0)}`])], "0");
    get("note").hidden = !about.simplified;
    state.hidden = new Set(about.hidden);
    get("bodies").replaceChildren(...about.bodies.map((name, body) => {
      const label = document.createElement("label"), box = document.createElement("input");
      box.type = "checkbox"; box.checked = !state.hidden.has(body);
      box.addEventListener("change", () => { state.hidden[box.checked ? "delete" : "add"](body); limitSlider(); draw(); });
      label.append(box, ` ${name}`);
      return label;
    }));
  }

  function turn(azimuth, elevation, zoom = 1) {
    readCamera();
    state.direction = [state.direction[0] + azimuth, Math.max(-88, Math.min(88, state.direction[1] + elevation))];
    state.distance = Math.max(NEAREST, Math.min(FARTHEST, state.distance * zoom));
    Plotly.relayout(get("plot"), { "scene.camera": camera() }).then(count);
  }

  // Pictures on the screen so far: the library draws in the animation frame after its promise.
  function count() {
    requestAnimationFrame(() => requestAnimationFrame(() => {
      root.dataset.frame = String(Number(root.dataset.frame || 0) + 1);
    }));
  }

  // The direction to which the mouse has turned the picture.
  function readCamera() {
    const { x, y, z } = get("plot")._fullLayout.scene._scene.getCamera().eye;
    state.distance = Math.hypot(x, y, z);
    state.direction = [Math.atan2(y, x) * 180 / Math.PI, Math.asin(z / state.distance) * 180 / Math.PI];
  }

  const KEYS = {
    ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, TURN], ArrowDown: [0, -TURN],
    "+": [0, 0, 1 / 1.2], "-": [0, 0, 1.2],
  };

  function connect() {
    const redraw = (change) => () => { readCamera(); change(); draw(); };
    get("field").addEventListener("change", redraw(() => { offerField(); placeSlider(); }));
    get("axis").addEventListener("change", redraw(placeSlider));
    for (const name of ["quantity", "factor", "side"]) get(name).addEventListener("change", redraw(() => {}));
    get("position").addEventListener("input", redraw(() => {}));
    for (const button of root.querySelectorAll("button[data-view]")) {
      button.addEventListener("click", () => {
        state.direction = [...VIEWS[button.dataset.view]];
        state.distance = startDistance();
        Plotly.relayout(get("plot"), { "scene.camera": camera() }).then(count);
      });
    }
    for (const button of root.querySelectorAll("button[data-key]")) {
      button.addEventListener("click", () => turn(...KEYS[button.dataset.key]));
    }
    get("plot").addEventListener("keydown", (event) => {
      if (!(event.key in KEYS)) return;
      event.preventDefault();
      turn(...KEYS[event.key]);
    });
  }

  function hasWebGL() {
    try {
      return Boolean(document.createElement("canvas").getContext("webgl"));
    } catch {
      return false;
    }
  }

  // The library measures its letters by reading canvases back, which browsers want to be told beforehand.
  function announceReading() {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function getContext(kind, options) {
      return original.call(this, kind, kind === "2d" ? { willReadFrequently: true, ...options } : options);
    };
  }

  async function start() {
    if (!hasWebGL() || typeof DecompressionStream === "undefined") {
      get("missing").hidden = false;
      return;
    }
    announceReading();
    const library = document.createElement("script");
    library.textContent = new TextDecoder().decode(await unpack(document.getElementById("viewer-library").textContent));
    document.head.append(library);
    arrays = decode(await unpack(scene.block));
    offer(get("field"), scene.fields.map((field, number) => [
      String(number), `gearbox ${field.gearbox}, stage ${field.stage.replaceAll("_", " ")}`,
    ]), String(scene.first));
    offerField();
    placeSlider();
    root.classList.add("live");
    state.distance = startDistance();
    connect();
    draw();
  }

  // The library is unpacked when the picture comes into sight, so that the page itself opens at once.
  if (typeof IntersectionObserver === "undefined") start();
  else {
    const watch = new IntersectionObserver((entries) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      watch.disconnect();
      start().catch((error) => {
        root.classList.remove("live");
        get("missing").hidden = false;
        console.error(error);
      });
    }, { rootMargin: "300px" });
    watch.observe(root);
  }
})();
