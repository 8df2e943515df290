// The page of `page/dist` in headless Chromium: texts, mistakes, methods, charts and links, and the ends of runs beside
// those of a native build.

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test, before, after } from 'node:test';
import { Chromium, served } from './chromium.mjs';

const file = (path) => new URL(path, import.meta.url);
const ends = readFileSync(file('ends.txt'), 'utf8').trim().split('\n').map((line) => {
    const [example, method, h, q] = line.split('\t');
    return { example, method, h: Number(h), q: q.split(' ').map(Number) };
});
const STEPS = 100;

let page;
let browser;

before(async () => {
    page = await served(file('../dist').pathname);
    browser = await Chromium.launch(process.env.CHROMIUM ?? 'chromium', { width: 1300, height: 900 });
});

after(async () => {
    await browser?.close();
    page?.close();
});

const write = (text) =>
    browser.value(`{ const of = document.getElementById('text'); of.value = ${JSON.stringify(text)};
        of.dispatchEvent(new Event('input')); document.getElementById('line').textContent = ''; }`);
const choose = (id, value, event) =>
    browser.value(`{ const of = document.getElementById('${id}'); of.value = ${JSON.stringify(value)};
        document.getElementById('legend').replaceChildren(); document.getElementById('line').textContent = '';
        of.dispatchEvent(new Event('${event}')); }`);
const words = (id) => browser.value(`document.getElementById('${id}').innerText`);
const error = (kind) => browser.value(`Number(document.getElementById('legend').dataset.${kind})`);
const isMeasured = "/Compiled in .* a step/.test(document.getElementById('line').textContent)";

async function open(hash) {
    await browser.open('about:blank');
    await browser.open(page.address + hash);
    await browser.until(isMeasured);
}

// Whether a canvas has points of a colour of the style sheet.
const isDrawn = (id, colour) => browser.value(`{
    const of = document.getElementById('${id}');
    const probe = document.createElement('canvas').getContext('2d');
    probe.fillStyle = getComputedStyle(document.documentElement).getPropertyValue('${colour}');
    probe.fillRect(0, 0, 1, 1);
    const [r, g, b] = probe.getImageData(0, 0, 1, 1).data;
    const { data } = of.getContext('2d').getImageData(0, 0, of.width, of.height);
    let count = 0;
    for (let at = 0; at < data.length; at += 4) {
        count += Math.abs(data[at] - r) + Math.abs(data[at + 1] - g) + Math.abs(data[at + 2] - b) < 12 && data[at + 3] > 200;
    }
    count > 20 }`);

test('each method of each example ends where a native build ends', async () => {
    await open('');
    const found = await browser.value(`(async () => {
        const { Engine } = await import('./engine.js');
        const { EXAMPLES, textOf } = await import('./examples.js');
        const engine = await Engine.load('vi_page.wasm');
        const ends = [];
        for (const { example, method, h } of ${JSON.stringify(ends)}) {
            const { facts } = engine.compile(await textOf(EXAMPLES.find(({ id }) => id === example)));
            const numbers = [...facts.parameters.map(({ value }) => value), ...facts.start.q, ...facts.start.v];
            const begun = engine.begin(facts.methods.indexOf(method), h, 0, numbers);
            const { rows, error } = engine.advance(Infinity, ${STEPS});
            const size = facts.coordinates.length;
            const last = rows.length - (2 * size + 3);
            ends.push({ error: begun.error ?? error, count: rows.length / (2 * size + 3), q: [...rows.slice(last + 1, last + 1 + size)] });
        }
        return ends;
    })()`);
    let largest = 0;
    found.forEach(({ error, count, q }, index) => {
        assert.equal(error, undefined);
        assert.equal(count, STEPS);
        q.forEach((value, at) => (largest = Math.max(largest, Math.abs(value - ends[index].q[at]))));
    });
    console.log(`the largest difference from a native build is ${largest}`);
    assert.ok(largest <= DIFFERENCE, `${largest}`);
});

test('rows have the motion between nodes, and the errors of all steps', async () => {
    const found = await browser.value(`(async () => {
        const { Rows } = await import('./rows.js');
        // q = t³ - t, whose cubic polynomial is exact.
        const row = (t, own) => [t, t ** 3 - t, 3 * t ** 2 - 1, own, -t];
        const rows = new Rows(1, row(0, 0));
        const STEPS = 100_000;
        for (let step = 1; step <= STEPS; step += 1) rows.push(row(step / 8, step === 777 ? -5 : (step % 2) * 1e-3));
        const { bins } = rows.errors;
        const t = STEPS / 8 - 0.3;
        return {
            off: Math.abs(rows.at(t)[0] / (t ** 3 - t) - 1),
            ends: [rows.last, rows.first > 0, rows.errors.begin, bins.at(-1).t],
            count: bins.length,
            lows: bins.filter(({ own }) => own[0] === -5).map(({ t }) => t >= 777 / 8 && t < 777 / 8 + 32),
            high: Math.max(...bins.map(({ own }) => own[1])),
            isAscending: bins.every((bin, at) => at === 0 || bin.t > bins[at - 1].t),
            covered: bins.every(({ t, rival }, at) => rival[0] === -t && (at === 0 || rival[1] < -bins[at - 1].t)),
        };
    })()`);
    assert.ok(found.off < 1e-13, `${found.off}`);
    assert.deepEqual(found.ends, [12500, true, 0, 12500]);
    assert.ok(found.count > 500 && found.count <= 1200);
    assert.deepEqual([found.lows, found.high, found.isAscending, found.covered], [[true], 1e-3, true, true]);
});

test('each example runs with each of its methods', async () => {
    for (const example of new Set(ends.map((of) => of.example))) {
        await open(`#${example}`);
        const methods = await browser.value("[...document.getElementById('method').options].map((of) => of.value)");
        assert.deepEqual(methods.toSorted(), ends.filter((of) => of.example === example).map((of) => of.method).toSorted());
        for (const method of methods) {
            await choose('method', method, 'change');
            await browser.until(`${isMeasured} && document.getElementById('legend').innerText.includes('RK4')`);
            await browser.until('Number(document.getElementById("legend").dataset.own) > 0');
            assert.equal(await words('ended'), '', `${example} ${method}`);
            assert.ok((await error('own')) < (method === 'fixed' ? 1 : 1e-8), `${example} ${method}`);
        }
    }
});

test('a text that is typed runs', async () => {
    await open('#pendulum');
    await write('struct Springs { param k = 4.0; coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - k * (x^2 + (x - y)^4) / 2; check { x = 1.0, dot(y) = 0.5; h = 0.01; } }');
    await browser.until(isMeasured);
    await browser.until('Number(document.getElementById("legend").dataset.own) > 0');
    assert.ok((await error('own')) < 1e-9);
    assert.equal(await words('mistakes'), '');
    // Without a rule there are only Gauss steps.
    assert.deepEqual(await browser.value("[...document.getElementById('method').options].map((of) => of.value)"), ['gauss 4', 'gauss 8']);
    const names = await browser.value("[...document.querySelectorAll('#sliders label span')].map((of) => of.textContent)");
    assert.deepEqual(names, ['k', 'x', 'y', 'dot(x)', 'dot(y)']);
    // Coordinates against time, in the colours of two series, and both errors.
    assert.ok((await isDrawn('motion', '--series-1')) && (await isDrawn('motion', '--series-2')));
    await browser.until('Number(document.getElementById("legend").dataset.rival) > 0');
    assert.ok((await isDrawn('energy', '--own')) && (await isDrawn('energy', '--rival')));
});

test('a system with a force shows its energy', async () => {
    await open('#pendulum');
    await write('struct Damped { param c = 0.1; coord x; L = dot(x)^2 / 2 - x^2 / 2; force x = -c * dot(x); }');
    await browser.until(isMeasured);
    await browser.until('/^Energy\\s/.test(document.getElementById("legend").innerText)');
    assert.ok(!(await words('legend')).includes('RK4'));
});

test('a slider restarts the run with its value', async () => {
    await open('#pendulum');
    await browser.value(`{ const of = document.querySelector('#sliders input'); of.value = 2.5; of.dispatchEvent(new Event('input')); }`);
    assert.equal(await browser.value("document.querySelector('#sliders output').textContent"), '2.5');
    await browser.until('Number(document.getElementById("legend").dataset.own) > 0');
    assert.ok((await error('own')) < 1e-9);
});

test('mistakes are shown at their tokens', async () => {
    await open('#kepler');
    await write('struct S {\n    coord θ;\n    L = dot(θ)^2 / 2 - kk * θ^2;\n}');
    await browser.until("document.querySelector('.mistake')");
    assert.equal(await browser.value("[...document.querySelectorAll('.wrong')].map((of) => of.textContent).join('')"), 'kk');
    assert.match(await words('mistakes'), /^line 3\s+unknown name kk/i);
    // A click selects the token.
    await browser.value("document.querySelector('.mistake').click()");
    const selected = "{ const of = document.getElementById('text'); of.value.slice(of.selectionStart, of.selectionEnd) }";
    assert.equal(await browser.value(selected), 'kk');
    // The mark covers the same letters as the text field.
    await write('struct S { coord x; L = dot(x)^2 / 2 - x^2; ');
    await browser.until("document.querySelector('.mistake')?.innerText.includes('closed')");
    assert.equal(await browser.value("document.querySelector('.wrong').textContent"), '{');
    await write('struct S { coord x; L = dot(x)^2 / 2 - x^2; }');
    await browser.until(isMeasured);
    assert.equal(await browser.value("document.querySelectorAll('.wrong').length"), 0);
});

test('hostile texts are refused, and the page goes on', async () => {
    await open('#kepler');
    const deep = `${'sin('.repeat(20000)}x${')'.repeat(20000)}`;
    const long = Array.from({ length: 3000 }, (_, k) => `sin(${k + 1} * x)^${(k % 7) + 1}`).join(' + ');
    const refused = [
        `struct S { coord x; L = dot(x)^2 / 2 - ${deep}; }`,
        'struct S { coord q[9]; L = sum(i in 0..9, dot(q[i])^2 - q[i]^4) / 2; }',
        'struct S { coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - y; constraint rod = x^2 + y^2 - 1; }',
        '<img src=x onerror=alert(1)>',
    ];
    for (const text of refused) {
        await write(text);
        await browser.until("/Refused/.test(document.getElementById('line').textContent)");
        assert.notEqual(await words('mistakes'), '');
        assert.equal(await browser.value("document.querySelectorAll('main img').length"), 0);
    }
    await write(`struct S { coord x; L = dot(x)^2 / 2 - (${long}); }`);
    await browser.until(`${isMeasured} || /Refused/.test(document.getElementById('line').textContent)`);
    await write('struct S { coord x; L = dot(x)^2 / 2 - x^2; }');
    await browser.until(isMeasured);
});

test('a step that does not exist is reported', async () => {
    await open('#double_pendulum');
    await choose('method', 'energy', 'change');
    await browser.until(isMeasured);
    await choose('step', 5, 'input');
    await choose('speed', 6, 'input');
    await browser.until("document.getElementById('ended').textContent");
    assert.match(await words('ended'), /energy-preserving step|converge/);
});

test('a link has the text and its numbers', async () => {
    await open('#kepler');
    await browser.value(`{ const of = document.querySelector('#sliders input'); of.value = 1.5; of.dispatchEvent(new Event('input')); }`);
    await browser.value("document.getElementById('share').click()");
    await browser.until("location.hash.startsWith('#text=')");
    const hash = await browser.value('location.hash');
    const text = await browser.value("document.getElementById('text').value");
    await open(hash);
    assert.equal(await browser.value("document.getElementById('text').value"), text);
    assert.equal(await browser.value("document.querySelector('#sliders output').textContent"), '1.5');
    // A link of nonsense opens an example.
    await open('#text=%%%');
});

test('dark and narrow pages have no scroll bar across', async () => {
    for (const width of [360, 800, 1300]) {
        await browser.send('Emulation.setDeviceMetricsOverride', { width, height: 800, deviceScaleFactor: 1, mobile: false });
        await browser.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: 'dark' }] });
        await open('#figure_eight');
        assert.ok(await browser.value('document.documentElement.scrollWidth <= innerWidth'), `${width}`);
        await browser.until('Number(document.getElementById("legend").dataset.own) > 0');
        assert.ok(await isDrawn('energy', '--own'));
    }
});

test('nothing was thrown', () => assert.deepEqual(browser.thrown, []));

// WebAssembly has no fused multiply-add: measured 3.4e-16.
const DIFFERENCE = 4e-16;
