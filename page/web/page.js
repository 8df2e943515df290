// The page: from the text to its motion.

import { Editor, element } from './editor.js';
import { drawEnergy, worst } from './energy.js';
import { EXAMPLES, sceneOf, textOf } from './examples.js';
import { Rows } from './rows.js';
import { drawMotion } from './scene.js';
import { short } from './canvas.js';

const METHODS = {
    'gauss 8': { title: 'Gauss, order 16', tolerance: 1e-14 },
    'gauss 4': { title: 'Gauss, order 8', tolerance: 1e-11 },
    fixed: { title: 'Fixed step, order 2', tolerance: 1e-4 },
    energy: { title: 'Energy-preserving, order 2', tolerance: 1e-4 },
};
const PAUSE = 250; // milliseconds without a key, before the text is compiled
const AHEAD = 0.1; // seconds of the motion that are computed before they are shown
const WINDOW = 10; // seconds in which the window of a chart passes
const SHOWN_STEPS = 100; // in this window, of a system that is no example

const find = (id) => document.getElementById(id);
const parts = Object.fromEntries(
    ['text', 'shown', 'mistakes', 'examples', 'share', 'line', 'sliders', 'method', 'step', 'step-shown', 'motion',
        'play', 'restart', 'speed', 'speed-shown', 'views', 'energy', 'legend', 'ended'].map((id) => [id, find(id)]),
);

// Requests to the worker, answered in their order.
const worker = new Worker('worker.js', { type: 'module' });
const waiting = new Map();
let requests = 0;
worker.onmessage = ({ data: { id, ...answer } }) => {
    waiting.get(id)(answer);
    waiting.delete(id);
};
worker.onerror = () => say('The compiler could not be loaded.');
const ask = (kind, request) =>
    new Promise((resolve) => {
        requests += 1;
        waiting.set(requests, resolve);
        worker.postMessage({ id: requests, kind, ...request });
    });

// The system of the text, with the values of its parameters, coordinates and velocities; none while the text is wrong.
let model;
// The run of the model; none until it has begun.
let run;
let isPlaying = !matchMedia('(prefers-reduced-motion: reduce)').matches;
let isCoordinates = false;
// Counts what a later request replaces.
let versions = 0;

const editor = new Editor(parts.text, parts.shown, parts.mistakes, () => {
    const version = (versions += 1);
    mark(undefined);
    setTimeout(() => version === versions && compile(), PAUSE);
});

async function compile(chosen = {}) {
    const version = (versions += 1);
    stop();
    const answer = await ask('compile', { text: editor.text });
    if (version !== versions) return;
    if (answer.failure) answer.mistakes = { text: `The compiler stopped: ${answer.failure}`, each: [] };
    editor.show(answer.mistakes);
    document.body.classList.toggle('is-wrong', Boolean(answer.mistakes));
    for (const part of [parts.sliders, parts.method, parts.step]) part.inert = Boolean(answer.mistakes);
    if (answer.mistakes) {
        model = undefined;
        say(`Refused in ${short(answer.milliseconds ?? 0)} ms`);
        return;
    }
    const { facts, milliseconds } = answer;
    const { parameters, start } = facts;
    const defaults = [...parameters.map(({ value }) => value), ...start.q, ...start.v];
    const values = chosen.values?.length === defaults.length ? chosen.values : defaults;
    const method = [chosen.method, parts.method.value, 'gauss 8'].find((name) => facts.methods.includes(name));
    model = { facts, milliseconds, defaults, values: Float64Array.from(values), scene: sceneOf(facts), method };
    showMethods();
    showSliders();
    showViews();
    await begin(chosen.h);
}

// Ends the run: the worker has one, and requests of this one would advance the next.
function stop() {
    run = undefined;
    parts.ended.textContent = '';
}

// Begins the run of the model. Without a step it takes the longest one whose error is small.
async function begin(h) {
    const version = (versions += 1);
    stop();
    const { facts, method, values } = model;
    const index = facts.methods.indexOf(method);
    const { tolerance } = METHODS[method];
    if (h === undefined) {
        const found = await ask('begin', { method: index, h: 0, tolerance, numbers: values });
        if (version !== versions) return;
        if (found.error || found.failure) return ended(found.error ?? found.failure);
        h = Number(found.h.toPrecision(2));
        model.usual = undefined;
    }
    if (model.usual === undefined) {
        model.usual = h;
        parts.step.value = 0;
    }
    model.h = h;
    const begun = await ask('begin', { method: index, h, tolerance, numbers: values });
    if (version !== versions) return;
    showStep();
    if (begun.error || begun.failure) return ended(begun.error ?? begun.failure);
    const size = facts.coordinates.length;
    const rows = new Rows(size, [0, ...values.slice(-2 * size), 0, 0]);
    const span = model.scene?.span ?? SHOWN_STEPS * model.usual;
    run = { ...model, rows, span: Number(span.toPrecision(1)), energy: begun.energy, t: 0, isAsked: false, error: undefined };
    draw();
    await measure(run);
}

async function measure(of) {
    const { facts, method, h, values, milliseconds } = of;
    const { nanoseconds } = await ask('measure', { method: facts.methods.indexOf(method), h, numbers: values });
    if (of !== run) return;
    const compiled = `Compiled in ${short(Number(milliseconds.toPrecision(2)))} ms`;
    say(nanoseconds === undefined ? compiled : `${compiled} · ${duration(nanoseconds)} a step`);
}

function duration(nanoseconds) {
    const rounded = Number(nanoseconds.toPrecision(2));
    return rounded < 1000 ? `${rounded} ns` : `${short(rounded / 1000)} µs`;
}

function ended(error) {
    say('');
    explain(error);
    parts.legend.replaceChildren();
    for (const canvas of [parts.motion, parts.energy]) canvas.width = canvas.width;
}

function explain(error) {
    parts.ended.textContent = `The run ends: ${error}. Try another method or a shorter step.`;
}

function say(words) {
    parts.line.textContent = words;
}

// Frames.

let before = performance.now();

function frame(now) {
    const seconds = Math.min(now - before, 100) / 1000;
    before = now;
    if (run && isPlaying && run.error === undefined) {
        const speed = speedOf(run);
        run.t = Math.min(run.t + seconds * speed, run.rows.last);
        request(run, run.t + (seconds + AHEAD) * speed);
        draw();
    }
    requestAnimationFrame(frame);
}

async function request(of, end) {
    if (of.isAsked || of.rows.last >= end) return;
    of.isAsked = true;
    const { rows, error, failure } = await ask('advance', { end, stride: of.rows.stride });
    if (of !== run) return;
    of.isAsked = false;
    if (rows) of.rows.push(rows);
    of.error = error ?? failure;
    if (of.error) {
        of.t = of.rows.last;
        explain(of.error);
        draw();
    }
}

function draw() {
    if (!run) return;
    drawMotion(parts.motion, { ...run, scene: isCoordinates ? undefined : run.scene }, run.t);
    drawEnergy(parts.energy, run);
    showLegend();
}

function showLegend() {
    const { facts, method, rows, energy } = run;
    const { title } = METHODS[method];
    const last = rows.errors.bins.at(-1);
    if (!facts.conserves) {
        parts.legend.replaceChildren(element('strong', '', 'Energy'), entry('own', title, short(energy + last.own[1])));
        return;
    }
    const largest = (of) => rows.errors.bins.reduce((most, bin) => Math.max(most, worst(of(bin))), 0);
    const [own, rival] = [largest((bin) => bin.own), largest((bin) => bin.rival)];
    parts.legend.replaceChildren(
        element('strong', '', 'Energy error'),
        entry('own', title, exponent(own)),
        entry('rival', 'RK4, as many evaluations', Number.isFinite(rival) ? exponent(rival) : 'diverged'),
    );
    parts.legend.dataset.own = own;
    parts.legend.dataset.rival = rival;
}

function exponent(value) {
    return value === 0 ? '0' : value.toExponential(1).replace('e+', 'e');
}

function entry(kind, words, number) {
    return element('span', kind, element('i', ''), words, ' ', element('b', '', number));
}

// Controls.

function showMethods() {
    parts.method.replaceChildren(
        ...model.facts.methods.map((name) => new Option(METHODS[name].title, name, false, name === model.method)),
    );
}

function showStep() {
    parts['step-shown'].textContent = short(model.h);
}

function speedOf({ span }) {
    return (span / WINDOW) * 2 ** Number(parts.speed.value);
}

function showPlaying() {
    parts.play.textContent = isPlaying ? 'Pause' : 'Play';
}

function showSpeed() {
    parts['speed-shown'].textContent = `${short(Number((2 ** Number(parts.speed.value)).toPrecision(2)))}×`;
}

function showViews() {
    const views = model.scene ? ['Motion', 'Coordinates'] : [];
    parts.views.replaceChildren(
        ...views.map((title, index) => {
            const button = element('button', '', title);
            button.type = 'button';
            button.setAttribute('aria-pressed', String(isCoordinates === Boolean(index)));
            button.addEventListener('click', () => {
                isCoordinates = Boolean(index);
                showViews();
                draw();
            });
            return button;
        }),
    );
}

function showSliders() {
    const { facts } = model;
    const count = facts.parameters.length;
    const group = (title, names, from) => {
        const made = element('details', '', element('summary', '', title));
        made.open = names.length <= 6;
        made.append(...names.map(({ name, about }, index) => slider(name, about, from + index)));
        return made;
    };
    const state = [...facts.coordinates, ...facts.coordinates.map((name) => `dot(${name})`)].map((name) => ({ name, about: '' }));
    const groups = [group('Start', state, count)];
    if (count) groups.unshift(group('Parameters', facts.parameters, 0));
    parts.sliders.replaceChildren(...groups);
}

function slider(name, about, index) {
    const value = model.defaults[index];
    const isParameter = index < model.facts.parameters.length;
    const [low, high] = range(value, isParameter);
    const input = element('input', '');
    Object.assign(input, { type: 'range', min: low, max: high, step: 'any', value: model.values[index], title: about });
    const shown = element('output', '', short(model.values[index]));
    input.addEventListener('input', () => {
        model.values[index] = Number(Number(input.value).toPrecision(3));
        shown.textContent = short(model.values[index]);
        begin(model.h);
    });
    return element('label', '', element('span', '', name), input, shown);
}

// The values of a slider. A parameter keeps its sign: few masses and lengths may be zero.
function range(value, isParameter) {
    if (isParameter && value !== 0) return [value / 10, value * 3].sort((a, b) => a - b);
    const width = Math.max(2, Math.abs(value));
    return [value - width, value + width];
}

parts.method.addEventListener('change', () => {
    model.method = parts.method.value;
    begin();
});
parts.step.addEventListener('input', () => {
    if (model?.usual !== undefined) begin(Number((model.usual * 2 ** Number(parts.step.value)).toPrecision(2)));
});
parts.speed.addEventListener('input', showSpeed);
parts.restart.addEventListener('click', () => {
    if (model) begin(model.h);
});
parts.play.addEventListener('click', () => {
    isPlaying = !isPlaying;
    showPlaying();
});
new ResizeObserver(draw).observe(parts.motion);
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);

// Examples and links.

for (const example of EXAMPLES) {
    const button = element('button', '', example.title);
    button.type = 'button';
    button.dataset.id = example.id;
    button.addEventListener('click', () => open(example));
    parts.examples.append(button);
}

async function open(example) {
    mark(example);
    history.replaceState(null, '', `#${example.id}`);
    editor.text = await textOf(example);
    await compile();
}

function mark(example) {
    for (const button of parts.examples.children) {
        button.setAttribute('aria-pressed', String(button.dataset.id === example?.id));
    }
}

parts.share.addEventListener('click', async () => {
    const state = { text: editor.text };
    if (model) Object.assign(state, { values: [...model.values], method: model.method, h: model.h });
    const bytes = new TextEncoder().encode(JSON.stringify(state));
    const code = btoa(String.fromCharCode(...bytes)).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
    history.replaceState(null, '', `#text=${code}`);
    await navigator.clipboard?.writeText(location.href).catch(() => {});
    parts.share.textContent = 'Link copied';
    setTimeout(() => (parts.share.textContent = 'Copy link'), 1500);
});

// The state of a link; none if it has none.
function linked() {
    try {
        const code = location.hash.match(/^#text=(.+)$/)[1].replaceAll('-', '+').replaceAll('_', '/');
        const bytes = Uint8Array.from(atob(code), (letter) => letter.charCodeAt(0));
        const { text, values, method, h } = JSON.parse(new TextDecoder().decode(bytes));
        return typeof text === 'string' ? { text, values, method, h } : undefined;
    } catch {
        return undefined;
    }
}

async function openAddress() {
    const state = linked();
    if (state) {
        mark(undefined);
        editor.text = state.text;
        await compile(state);
    } else {
        await open(EXAMPLES.find(({ id }) => location.hash === `#${id}`) ?? EXAMPLES[1]);
    }
}

window.addEventListener('hashchange', openAddress);
showPlaying();
showSpeed();
requestAnimationFrame(frame);
openAddress();
