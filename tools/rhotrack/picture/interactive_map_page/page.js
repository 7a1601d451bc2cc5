// SPDX-License-Identifier: MIT
// Script of the page that `rhotrack plot -o NAME.html` writes: plots on a canvas, with tracks as
// SVG above it. tools/rhotrack/picture/interactive_map_page.c writes the arrays of data into the
// page.
'use strict';

const element = id => document.getElementById(id);

// Decodes the base64 array in the element with this id, and removes the element.
function decodeArray(kind, id) {
    const text = atob(element(id).textContent);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < bytes.length; i++) bytes[i] = text.charCodeAt(i);
    element(id).remove();
    return new kind(bytes.buffer);
}

const scanTime = decodeArray(Float64Array, 'scan_time'),
    scanFirst = decodeArray(Uint32Array, 'scan_first');
const plotX = decodeArray(Float32Array, 'plot_x'), plotY = decodeArray(Float32Array, 'plot_y');
const plotFate = decodeArray(Uint32Array, 'plot_fate');
const trackId = decodeArray(Int32Array, 'track_id'),
    trackFirst = decodeArray(Uint32Array, 'track_first');
const trackTime = decodeArray(Float64Array, 'track_time'),
    trackRow = decodeArray(Float32Array, 'track_row');
const truthFirst = decodeArray(Uint32Array, 'truth_first'),
    truthPlace = decodeArray(Float32Array, 'truth_place');
const rayTime = decodeArray(Float64Array, 'ray_time'),
    rayLine = decodeArray(Float32Array, 'ray_line');
const sensors = decodeArray(Float32Array, 'sensors');
const zero_s = Number(document.body.dataset.zeroS);

const [X, Y, Z, VX, VY, MAJOR, MINOR, ANGLE, SIGMA_MPS, HITS, MISSES, SCORE, CONFIRMED,
    COLUMNS] = d3.range(14);
const value = (row, column) => trackRow[row * COLUMNS + column];
const numTracks = trackId.length;
const palette = ['#0072b2', '#d55e00', '#009e73', '#000000',
    '#cc79a7', '#56b4e9', '#e69f00', '#7f7f7f'];
const colour = track => palette[track % palette.length];

// The times at which the slider stops: all times of scans, tracks and bearings, sorted, each once.
const times = Float64Array.from(new Set([...scanTime, ...trackTime, ...rayTime])).sort();
if (times.length === 0) throw new Error('nothing has a time');

// ---- state of the view ----

const state = {at: times.length - 1, chosen: -1, window: Infinity, playing: false};
const shown = {none: true, tentative: true, track: true, bearings: true, tracks: true, ends: true,
    truth: true, sensors: true};
const now = () => times[state.at];
const before = () => times[Math.max(0, state.at - state.window)];
// Index one past the last row of a track up to the present time.
const endOfRowsNow = track =>
    d3.bisectRight(trackTime, now(), trackFirst[track], trackFirst[track + 1]);

// ---- the map: metres about the middle, one scale for both axes ----

const box = {x: [Infinity, -Infinity], y: [Infinity, -Infinity]};
function includeInBox(x, y) {
    if (x < box.x[0]) box.x[0] = x;
    if (x > box.x[1]) box.x[1] = x;
    if (y < box.y[0]) box.y[0] = y;
    if (y > box.y[1]) box.y[1] = y;
}
for (let i = 0; i < plotX.length; i++) includeInBox(plotX[i], plotY[i]);
for (let i = 0; i < trackTime.length; i++) includeInBox(value(i, X), value(i, Y));
for (let i = 0; i < truthPlace.length; i += 2) includeInBox(truthPlace[i], truthPlace[i + 1]);
if (plotX.length + trackTime.length + truthPlace.length === 0) {
    for (let i = 0; i < rayLine.length; i += 2) includeInBox(rayLine[i], rayLine[i + 1]);
}
for (let i = 0; i < sensors.length; i += 6) includeInBox(sensors[i + 1], sensors[i + 2]);
const middle = {x: d3.mean(box.x), y: d3.mean(box.y)};

const canvas = element('plots'), map = element('map'), over = d3.select('#over');
const world = d3.select('#world'), ends = d3.select('#ends'), axes = d3.select('#axes');
const context = canvas.getContext('2d');
let width = 1, height = 1, pixelsPerM = 1, image, pixels;
let view = d3.zoomIdentity;
const scale = () => pixelsPerM * view.k;
const toScreenX = x => view.applyX(width / 2 + (x - middle.x) * pixelsPerM);
const toScreenY = y => view.applyY(height / 2 - (y - middle.y) * pixelsPerM);
const toWorldX = x => (view.invertX(x) - width / 2) / pixelsPerM + middle.x;
const toWorldY = y => middle.y - (view.invertY(y) - height / 2) / pixelsPerM;

const zoom = d3.zoom().scaleExtent([0.3, 1e5]).on('zoom', event => {
    view = event.transform;
    element('tip').hidden = true;
    redraw();
});
over.call(zoom);

function resize() {
    const ratio = window.devicePixelRatio || 1;
    width = map.clientWidth;
    height = map.clientHeight;
    pixelsPerM = 0.9 * Math.min(width / Math.max(box.x[1] - box.x[0], 1),
        height / Math.max(box.y[1] - box.y[0], 1));
    canvas.width = Math.max(1, Math.round(width * ratio));
    canvas.height = Math.max(1, Math.round(height * ratio));
    image = context.createImageData(canvas.width, canvas.height);
    pixels = new Uint32Array(image.data.buffer);
    draw(); // at once, as resizing clears the canvas
}

// ---- plots: squares written into the canvas's pixels; plots of tracks are drawn last ----

const FATES = ['none', 'tentative', 'track'];
const FATE_COLOURS = [0xffb4aca6, 0xff2a8ce6, 0xff8a3c14]; // colours as alpha, blue, green, red

// For each fate, the ascending indices of its plots.
const plotsOf = FATES.map((name, fate) => {
    const list = new Uint32Array(plotFate.length);
    let count = 0;
    for (let i = 0; i < list.length; i++) {
        if (Math.min(plotFate[i], 2) === fate) list[count++] = i;
    }
    return list.slice(0, count);
});

function drawPlots() {
    const from = scanFirst[d3.bisectLeft(scanTime,
        state.window === Infinity ? -Infinity : before())];
    const to = scanFirst[d3.bisectRight(scanTime, now())];
    const ratio = canvas.width / width, columns = canvas.width, rows = canvas.height;
    const factor = scale() * ratio, left = toScreenX(middle.x) * ratio,
        top = toScreenY(middle.y) * ratio;
    const size = Math.round(ratio * (to - from > 200000 ? 1 : to - from > 10000 ? 2 : 3));
    let drawn = 0;
    pixels.fill(0);
    for (let fate = 0; fate < 3; fate++) {
        if (!shown[FATES[fate]]) continue;
        const list = plotsOf[fate], end = d3.bisectLeft(list, to), bits = FATE_COLOURS[fate];
        for (let k = d3.bisectLeft(list, from); k < end; k++) {
            const i = list[k];
            const x = Math.round(left + (plotX[i] - middle.x) * factor);
            const y = Math.round(top - (plotY[i] - middle.y) * factor);
            if (x < 0 || y < 0 || x + size > columns || y + size > rows) continue;
            drawn++;
            for (let row = 0; row < size; row++) {
                const at = (y + row) * columns + x;
                for (let column = 0; column < size; column++) pixels[at + column] = bits;
            }
        }
    }
    context.putImageData(image, 0, 0);
    document.body.dataset.plotsDrawn = drawn;
    if (shown.bearings) drawBearings(ratio);
}

// Draws the bearings of the last scans only: all of them would hide the rest.
const RAYS_SCANS = 20, RAYS_MAX = 5000;
function drawBearings(ratio) {
    const from = d3.bisectLeft(rayTime,
        times[Math.max(0, state.at - Math.min(state.window, RAYS_SCANS))]),
        to = d3.bisectRight(rayTime, now());
    const step = Math.ceil((to - from) / RAYS_MAX) || 1;
    context.strokeStyle = to - from > 200 ? '#8a6d3b40' : '#8a6d3ba0';
    context.lineWidth = ratio;
    context.beginPath();
    for (let i = from; i < to; i += step) {
        context.moveTo(toScreenX(rayLine[4 * i]) * ratio, toScreenY(rayLine[4 * i + 1]) * ratio);
        context.lineTo(toScreenX(rayLine[4 * i + 2]) * ratio,
            toScreenY(rayLine[4 * i + 3]) * ratio);
    }
    context.stroke();
}

// ---- sensors, truth and tracks as SVG ----

const path = d3.line().x(place => place[0] - middle.x).y(place => place[1] - middle.y).digits(2);
const pathOfRows = (from, to) =>
    path(d3.range(from, to).map(row => [value(row, X), value(row, Y)]));

function createWorld() {
    for (let i = 0; i < sensors.length; i += 6) {
        const [id, x, y, range, from, to] = sensors.slice(i, i + 6);
        const group = world.append('g').attr('class', 'sensors')
            .attr('transform', `translate(${x - middle.x},${y - middle.y})`);
        const step = d3.tickStep(0, Math.max(box.x[1] - box.x[0], box.y[1] - box.y[0]), 10);
        if (range || sensors.length === 6) {
            const corner = Math.hypot(Math.max(box.x[1] - x, x - box.x[0]),
                Math.max(box.y[1] - y, y - box.y[0]));
            const end = Math.min(range || 5 * step, corner + step, 12 * step);
            for (const radius of step > 0 ? d3.range(step, end * (1 + 1e-6), step) : []) {
                group.append('circle').attr('class', 'ring').attr('r', radius);
            }
        }
        if (range > 0) {
            const angle = to > from ? [from, to]
                : to < from ? [from, to + 2 * Math.PI] : [0, 2 * Math.PI];
            group.append('path').attr('class', 'coverage').attr('d', d3.arc()({innerRadius: 0,
                outerRadius: range, startAngle: Math.PI / 2 - angle[0],
                endAngle: Math.PI / 2 - angle[1]}))
                .attr('transform', 'scale(1,-1)');
        }
        group.append('title').text(`sensor ${id}`);
    }
    for (let i = 0; i + 1 < truthFirst.length; i++) {
        const places = d3.range(truthFirst[i], truthFirst[i + 1])
            .map(k => [truthPlace[2 * k], truthPlace[2 * k + 1]]);
        world.append('path').attr('class', 'truth').attr('d', path(places));
    }
    const groups = world.selectAll('.track').data(d3.range(numTracks)).join('g')
        .attr('class', 'track').attr('id', track => `track-${trackId[track]}`);
    groups.append('path').attr('class', 'line').attr('stroke', colour);
    groups.append('path').attr('class', 'hit')
        .on('mousemove', (event, track) => showTip(event, track))
        .on('mouseleave', () => { element('tip').hidden = true; })
        .on('click', (event, track) => { event.stopPropagation(); selectTrack(track); });
    return groups;
}

// for each track, the row up to which its path is drawn
const cut = new Int32Array(numTracks).fill(-1);
function drawTracks() {
    groups.each(function (track) {
        const until = endOfRowsNow(track);
        if (until !== cut[track]) {
            cut[track] = until;
            d3.select(this).selectAll('path')
                .attr('d', until - trackFirst[track] < 1 ? null
                    : pathOfRows(trackFirst[track], until));
        }
        d3.select(this).select('.line').classed('ended', hasTrackEnded(track))
            .classed('chosen', track === state.chosen);
    });
}

// Whether the track's last row is before the present time.
const hasTrackEnded = track => trackTime[trackFirst[track + 1] - 1] < now();
const ENDS_MAX = 300;

function drawTrackEnds() {
    const alive = !shown.ends ? [] : d3.range(numTracks).filter(track =>
        endOfRowsNow(track) > trackFirst[track]
        && (!hasTrackEnded(track) || track === state.chosen)).slice(0, ENDS_MAX);
    const fastest = d3.max(alive, track => Math.hypot(value(endOfRowsNow(track) - 1, VX),
        value(endOfRowsNow(track) - 1, VY)));
    // the fastest track's arrow has 50 pixels at the initial zoom
    const arrow_s = fastest > 0 ? 50 / fastest / pixelsPerM : 0;
    const group = ends.selectAll('g').data(alive, track => track).join(enter => {
        const added = enter.append('g');
        added.append('ellipse').attr('stroke', colour);
        added.append('line').attr('stroke', colour);
        added.append('circle').attr('r', 3).attr('fill', colour);
        added.append('text').attr('x', 7).attr('y', -5).text(track => trackId[track]);
        return added;
    });
    group.each(function (track) {
        const row = endOfRowsNow(track) - 1, self = d3.select(this);
        self.attr('transform',
            `translate(${toScreenX(value(row, X))},${toScreenY(value(row, Y))})`);
        self.select('line').attr('x2', value(row, VX) * arrow_s * pixelsPerM)
            .attr('y2', -value(row, VY) * arrow_s * pixelsPerM);
        self.select('ellipse').attr('rx', 2 * (value(row, MAJOR) || 0) * scale())
            .attr('ry', 2 * (value(row, MINOR) || 0) * scale())
            .attr('transform', `rotate(${-(value(row, ANGLE) || 0) * 180 / Math.PI})`);
    });
}

function drawAxes() {
    const unit = Math.max(width, height) / scale() > 4000 ? 1000 : 1,
        name = unit === 1 ? 'm' : 'km';
    const x = d3.scaleLinear([toWorldX(0) / unit, toWorldX(width) / unit], [0, width]);
    const y = d3.scaleLinear([toWorldY(height) / unit, toWorldY(0) / unit], [height, 0]);
    axes.selectAll('*').remove();
    axes.append('g').attr('transform', `translate(0,${height - 20})`)
        .call(d3.axisBottom(x).ticks(width / 110));
    axes.append('g').attr('transform', 'translate(46,0)').call(d3.axisLeft(y).ticks(height / 80));
    axes.append('text').attr('x', width - 6).attr('y', height - 24)
        .attr('text-anchor', 'end').text(`east (${name})`);
    axes.append('text').attr('x', 52).attr('y', 12).text(`north (${name})`);
}

// ---- one track ----

const fixedDigits = (digits, unit) => number =>
    Number.isNaN(number) ? '' : `${number.toFixed(digits)} ${unit}`;
const speed = row => Math.hypot(value(row, VX), value(row, VY));
const heading = row => (Math.atan2(value(row, VX), value(row, VY)) * 180 / Math.PI + 360) % 360;
// Heights that were not measured are 0 in all rows.
const hasHeights = d3.range(trackTime.length).some(row => value(row, Z));
const facts = [
    ['time', row => trackTime[row] + zero_s, fixedDigits(1, 's')],
    ['speed', speed, fixedDigits(1, 'm/s')],
    ['heading', heading, fixedDigits(0, '\u00b0')],
    ['height', row => hasHeights ? value(row, Z) : NaN, fixedDigits(0, 'm')],
    ['sigma of the place', row => value(row, MAJOR), fixedDigits(1, 'm')],
    ['sigma of the velocity', row => value(row, SIGMA_MPS), fixedDigits(1, 'm/s')],
    ['score', row => value(row, SCORE), fixedDigits(1, 'nat')],
    ['hits', row => value(row, HITS), fixedDigits(0, '')],
    ['misses', row => value(row, MISSES), fixedDigits(0, '')],
];
const factsOf = row => facts.map(([name, of, text]) => [name, text(of(row))])
    .filter(fact => fact[1] !== '');
const status = row => value(row, CONFIRMED) ? 'confirmed' : 'tentative';

// Shows the facts of the track's row that is nearest to the pointer.
function showTip(event, track) {
    const [x, y] = d3.pointer(event, over.node());
    const row = d3.least(
        d3.range(trackFirst[track], Math.max(endOfRowsNow(track), trackFirst[track] + 1)),
        i => Math.hypot(toScreenX(value(i, X)) - x, toScreenY(value(i, Y)) - y));
    const tip = element('tip');
    tip.textContent = `track ${trackId[track]}, ${status(row)}\n`
        + factsOf(row).map(fact => fact.join(': ')).join('\n');
    tip.style.left = `${Math.min(x + 14, width - 190)}px`;
    tip.style.top = `${Math.min(y + 14, height - 190)}px`;
    tip.hidden = false;
}

function selectTrack(track) {
    state.chosen = track;
    redraw();
}
over.on('click', () => selectTrack(-1));

const charts = [['speed (m/s)', speed], ['sigma of the place (m)', row => value(row, MAJOR)],
    ['score (nat)', row => value(row, SCORE)],
    ['plots taken of looks (%)',
        row => 100 * value(row, HITS) / (value(row, HITS) + value(row, MISSES))]];

function drawTrackPanel() {
    const panel = d3.select('#track').attr('hidden', state.chosen < 0 ? '' : null);
    const track = state.chosen;
    panel.selectAll('*').remove();
    if (track < 0) return;
    const first = trackFirst[track], until = Math.max(endOfRowsNow(track), first + 1),
        end = trackFirst[track + 1];
    panel.append('h2').text(`track ${trackId[track]}, ${status(until - 1)}`);
    panel.append('table').selectAll('tr').data([
        ['from, to',
            `${(trackTime[first] + zero_s).toFixed(1)}, `
            + `${(trackTime[end - 1] + zero_s).toFixed(1)} s`],
        ...factsOf(until - 1)]).join('tr')
        .selectAll('td').data(fact => fact).join('td').text(text => text);
    const rows = d3.range(first, end, Math.max(1, Math.floor((end - first) / 600)));
    for (const [name, of] of charts) {
        const values = rows.map(of);
        if (values.every(Number.isNaN)) continue;
        const x = d3.scaleLinear([trackTime[first], trackTime[end - 1]], [38, 255]);
        const y = d3.scaleLinear([Math.min(0, d3.min(values)), d3.max(values) || 1], [72, 18])
            .nice(3);
        const chart = panel.append('svg').attr('viewBox', '0 0 262 80').on('click', event => {
            goToTime(d3.bisectLeft(times, x.invert(d3.pointer(event)[0])));
        });
        chart.append('text').attr('y', 11).text(name);
        chart.append('g').attr('transform', 'translate(36,0)').call(d3.axisLeft(y).ticks(3));
        chart.append('path').attr('fill', 'none').attr('stroke', colour(track))
            .attr('stroke-width', 1.5)
            .attr('d', d3.line().defined(k => !Number.isNaN(values[k]))
                .x(k => x(trackTime[rows[k]])).y(k => y(values[k]))(d3.range(rows.length)));
        chart.append('line').attr('x1', x(trackTime[until - 1])).attr('x2', x(trackTime[until - 1]))
            .attr('y1', 16).attr('y2', 74).attr('stroke', '#999');
    }
}

// ---- drawing, at most once a frame ----

function draw() {
    const start = performance.now();
    drawPlots();
    world.attr('transform', `translate(${toScreenX(middle.x)},${toScreenY(middle.y)}) `
        + `scale(${scale()},${-scale()})`);
    world.selectAll('.sensors').attr('display', shown.sensors ? null : 'none');
    world.selectAll('.truth').attr('display', shown.truth ? null : 'none');
    world.selectAll('.track').attr('display', shown.tracks ? null : 'none');
    drawTracks();
    drawTrackEnds();
    drawAxes();
    drawTrackPanel();
    element('time').value = state.at;
    element('now').textContent = `${(now() + zero_s).toFixed(1)} s`;
    document.body.dataset.drawMs = (performance.now() - start).toFixed(1);
}

let isAsked = false;
function redraw() {
    if (isAsked) return;
    isAsked = true;
    requestAnimationFrame(() => {
        isAsked = false;
        draw();
    });
}

// ---- controls ----

function goToTime(at) {
    state.at = Math.max(0, Math.min(times.length - 1, at));
    redraw();
}

function play(isOn) {
    state.playing = isOn;
    element('play').textContent = isOn ? '\u275a\u275a' : '\u25b6';
    if (!isOn) return;
    if (state.at === times.length - 1) goToTime(0);
    const start = performance.now(), first = state.at;
    const timer = d3.timer(() => {
        const at = first + Math.floor((performance.now() - start) / 1000
            * Number(element('speed').value));
        if (!state.playing || state.at >= times.length - 1) {
            timer.stop();
            play(false);
        } else if (at !== state.at) {
            goToTime(at);
        }
    });
}

element('time').max = times.length - 1;
element('time').addEventListener('input', event => {
    play(false);
    goToTime(Number(event.target.value));
});
element('play').addEventListener('click', () => play(!state.playing));
element('speed').addEventListener('change', () => play(false));
element('window').addEventListener('change', event => {
    state.window = Number(event.target.value);
    redraw();
});
element('home').addEventListener('click', () => over.call(zoom.transform, d3.zoomIdentity));
document.addEventListener('keydown', event => {
    if (/INPUT|SELECT|BUTTON/.test(event.target.tagName)) return;
    if (event.key === ' ') play(!state.playing);
    else if (event.key === 'ArrowRight') goToTime(state.at + 1);
    else if (event.key === 'ArrowLeft') goToTime(state.at - 1);
    else return;
    event.preventDefault();
});

const counts = plotsOf.map(list => list.length);
const hex = bgr => `#${[bgr & 255, bgr >> 8 & 255, bgr >> 16 & 255]
    .map(part => part.toString(16).padStart(2, '0')).join('')}`;
const switches = [
    ['track', `plots of tracks: ${counts[2]}`, hex(FATE_COLOURS[2]), counts[2]],
    ['tentative', `of tracks never confirmed: ${counts[1]}`, hex(FATE_COLOURS[1]), counts[1]],
    ['none', `of no track: ${counts[0]}`, hex(FATE_COLOURS[0]), counts[0]],
    ['bearings', `bearings: ${rayTime.length}`, '#8a6d3b', rayTime.length],
    ['tracks', 'tracks', null, numTracks],
    ['ends', 'numbers, velocities, 2-sigma ellipses', null, numTracks],
    ['truth', 'truth', '#c0c0c0', truthPlace.length],
    ['sensors', 'sensors: rings, coverage', null, sensors.length],
];
for (const [name, text, dot] of switches.filter(one => one[3] > 0)) {
    const label = d3.select('#shown').append('label');
    label.append('input').attr('type', 'checkbox').attr('id', `show-${name}`)
        .property('checked', true)
        .on('change', event => { shown[name] = event.target.checked; redraw(); });
    if (dot) label.append('i').style('background', dot);
    label.append('span').text(` ${text}`);
}
const LISTED_MAX = 500;
if (numTracks > LISTED_MAX) {
    element('unlisted').textContent =
        `The first ${LISTED_MAX} of ${numTracks} tracks; the others are on the map.`;
}
d3.select('#list').selectAll('button')
    .data(d3.range(Math.min(numTracks, LISTED_MAX))).join('button')
    .style('border-left-color', colour).text(track => trackId[track])
    .on('click', (event, track) => {
        const last = trackFirst[track + 1] - 1;
        goToTime(Math.max(state.at, d3.bisectLeft(times, trackTime[trackFirst[track]])));
        selectTrack(track);
        over.call(zoom.translateTo, width / 2 + (value(last, X) - middle.x) * pixelsPerM,
            height / 2 - (value(last, Y) - middle.y) * pixelsPerM);
    });
element('title').textContent = document.title;
element('words').textContent = `${(times[times.length - 1] - times[0]).toFixed(1)} s `
    + `from ${(times[0] + zero_s).toFixed(1)} s on. `
    + 'Wheel: zoom; drag: move; a track: its history; space: play.';
const groups = createWorld();
new ResizeObserver(resize).observe(map);
resize();
requestAnimationFrame(() => requestAnimationFrame(() => {
    document.body.dataset.readyMs = performance.now().toFixed(0);
}));
