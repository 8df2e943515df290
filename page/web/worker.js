// Answers requests of the page in a thread of its own, so that the page stays responsive.

import { Engine } from './engine.js';

const STEPS = 32; // between two looks at the clock
const SLICE = 12; // milliseconds of an answer
const MEASURED = 25; // milliseconds of steps whose time is taken
const RUN = 256; // of these steps, from the start: later there may be no step

// A browser compiles WebAssembly when it is first called, which is no time of the text that is shown.
const FIRST = 'struct First { coord x; L = dot(x)^2 / 2 - cos(x); discretize midpoint; }';

const engine = Engine.load('vi_page.wasm').then((engine) => {
    engine.compile(FIRST);
    return engine;
});

const answers = {
    async compile(engine, { text }) {
        if (engine.isFull) await engine.renew();
        const begun = performance.now();
        const answer = engine.compile(text);
        return { ...answer, milliseconds: performance.now() - begun };
    },

    begin(engine, { method, h, tolerance, numbers }) {
        return engine.begin(method, h, tolerance, numbers);
    },

    // Rows until the time `end`, or fewer when the slice of time is over.
    advance(engine, { end, stride }) {
        const stop = performance.now() + SLICE;
        const parts = [];
        for (;;) {
            const { rows, error } = engine.advance(end, STEPS);
            parts.push(rows);
            if (error !== undefined || rows.length < STEPS * stride || performance.now() > stop) {
                return { rows: joined(parts), error };
            }
        }
    },

    // Nanoseconds of a step; none if a step failed.
    measure(engine, { method, h, numbers }) {
        const begun = performance.now();
        for (let steps = RUN; ; steps += RUN) {
            if (!engine.measure(method, h, numbers, RUN)) return {};
            const spent = performance.now() - begun;
            if (spent > MEASURED) return { nanoseconds: (spent * 1e6) / steps };
        }
    },
};

function joined(parts) {
    const all = new Float64Array(parts.reduce((sum, part) => sum + part.length, 0));
    let at = 0;
    for (const part of parts) {
        all.set(part, at);
        at += part.length;
    }
    return all;
}

self.onmessage = async ({ data: { id, kind, ...request } }) => {
    let answer;
    try {
        answer = await answers[kind](await engine, request);
    } catch (error) {
        // The instance may be in any state: a text that needs more memory or stack than a page has ends here.
        answer = { failure: String(error) };
        await engine.then((engine) => engine.renew()).catch(() => {});
    }
    self.postMessage({ id, ...answer }, answer.rows ? [answer.rows.buffer] : []);
};
