// The energy error of a run and of its rival against time, in powers of ten; the energy itself if it is not conserved.

import { drawn, line } from './canvas.js';
import { framed } from './scene.js';

const FLOOR = 1e-17; // below the rounding of any energy of unit size

export function drawEnergy(canvas, { rows, facts, span, energy }) {
    drawn(canvas, (context, size, colours) => {
        const { bins } = rows.errors;
        const x = [rows.errors.begin, Math.max(bins.at(-1).t, rows.errors.begin + span)];
        if (facts.conserves) drawErrors(context, size, colours, bins, x);
        else drawValues(context, size, colours, bins, x, energy);
    });
}

function drawErrors(context, size, colours, bins, x) {
    const largest = bins.flatMap(({ own, rival }) => [worst(own), worst(rival)]).filter(Number.isFinite);
    const top = Math.min(6, Math.max(-4, Math.ceil(Math.log10(Math.max(...largest, FLOOR)) + 0.2)));
    const y = [Math.log10(FLOOR) + 0.5, top];
    const marks = [-16, -12, -8, -4, 0, 4].filter((mark) => mark <= top);
    const place = framed(context, size, colours, { x, y, marks, spelled: power });
    const height = (value) => Math.min(top, Math.log10(Math.max(Math.abs(value), FLOOR)));
    const points = (of) => bins.filter((bin) => Number.isFinite(worst(of(bin)))).map((bin) => place(bin.t, Math.max(y[0], height(worst(of(bin))))));
    line(context, points(({ rival }) => rival), colours.rival, 1.75);
    line(context, points(({ own }) => own), colours.own, 2);
}

function drawValues(context, size, colours, bins, x, energy) {
    const values = bins.flatMap(({ own }) => own).map((of) => of + energy).filter(Number.isFinite);
    const [low, high] = [Math.min(...values), Math.max(...values)];
    const room = 0.1 * (high - low) || 1e-3 * Math.max(Math.abs(low), 1);
    const place = framed(context, size, colours, { x, y: [low - room, high + room] });
    line(context, bins.map(({ t, own }) => place(t, (own[0] + own[1]) / 2 + energy)), colours.own, 2);
}

export function worst([low, high]) {
    return Math.max(Math.abs(low), Math.abs(high));
}

function power(exponent) {
    const digits = { '-': '⁻', 0: '⁰', 1: '¹', 2: '²', 4: '⁴', 6: '⁶', 8: '⁸' };
    return exponent === 0 ? '1' : `10${[...String(exponent)].map((digit) => digits[digit]).join('')}`;
}
