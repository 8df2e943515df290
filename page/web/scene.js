// The motion at a time: arms, bodies in a plane, or coordinates against time.

import { disc, drawn, line, short, ticks, trail } from './canvas.js';

const POINTS = 240;

// `scene` as in the examples, or none for coordinates against time.
export function drawMotion(canvas, { rows, facts, scene, span, values }, t) {
    drawn(canvas, (context, size, colours) => {
        if (!scene) return drawCoordinates(context, size, colours, { rows, facts, span }, t);
        const paint = scene.arms ? drawArms : drawBodies;
        return paint(context, size, colours, { rows, scene, span, values }, t);
    });
}

// Coordinates at equal times of the window that ends at t.
function sampled(rows, from, t) {
    return Array.from({ length: POINTS + 1 }, (_, index) => rows.at(from + ((t - from) * index) / POINTS));
}

function drawArms(context, { width, height }, colours, { rows, scene, span, values }, t) {
    const lengths = scene.arms.map(([, length]) => Math.abs(values[length]));
    const masses = scene.arms.map(([, , mass]) => Math.max(0, values[mass]));
    const reach = lengths.reduce((sum, length) => sum + length, 0) || 1;
    const scale = (0.42 * Math.min(width, height)) / reach;
    const joints = (q) => {
        const all = [[width / 2, height / 2]];
        scene.arms.forEach(([angle], index) => {
            const [x, y] = all[index];
            const length = scale * lengths[index];
            all.push([x + length * Math.sin(q[angle]), y + length * Math.cos(q[angle])]);
        });
        return all;
    };
    const path = sampled(rows, Math.max(rows.first, t - span / 4), t).map((q) => joints(q).at(-1));
    trail(context, path, colours.own, 2);
    const now = joints(rows.at(t));
    line(context, [[width / 2 - 22, height / 2], [width / 2 + 22, height / 2]], colours.rule, 3);
    line(context, now, colours.ink, 2.5);
    disc(context, now[0], 3.5, colours.ink);
    const heaviest = Math.max(...masses) || 1;
    now.slice(1).forEach((at, index) => {
        disc(context, at, 5 + 8 * Math.cbrt(masses[index] / heaviest), colours.body);
    });
}

function drawBodies(context, { width, height }, colours, { rows, scene, span }, t) {
    const from = Math.max(rows.first, t - (scene.sun ? span : span / 5));
    const path = sampled(rows, from, t);
    const places = path.map((q) => scene.bodies.map(([x, y]) => [q[x], q[y]]));
    const all = sampled(rows, Math.max(rows.first, t - 1.5 * span), t).flatMap((q) => scene.bodies.map(([x, y]) => [q[x], q[y]]));
    if (scene.sun) all.push([0, 0]);
    const [least, most] = [Math.min, Math.max].map((of) => [0, 1].map((axis) => of(...all.map((at) => at[axis]))));
    const middle = [0, 1].map((axis) => (least[axis] + most[axis]) / 2);
    const extent = [0, 1].map((axis) => Math.max(most[axis] - least[axis], 1e-9));
    const widest = Math.max(...extent);
    const scale = 0.8 * Math.min(width / Math.max(extent[0], 0.5 * widest), height / Math.max(extent[1], 0.5 * widest));
    const shown = ([x, y]) => [width / 2 + scale * (x - middle[0]), height / 2 - scale * (y - middle[1])];
    if (scene.sun) disc(context, shown([0, 0]), 11, colours.rival);
    scene.bodies.forEach((_, body) => {
        const colour = scene.bodies.length > 1 ? colours.series[body] : colours.own;
        trail(context, places.map((of) => shown(of[body])), colour, 2);
        disc(context, shown(places.at(-1)[body]), 8, scene.bodies.length > 1 ? colour : colours.body);
    });
}

function drawCoordinates(context, size, colours, { rows, facts, span }, t) {
    const from = Math.max(rows.first, t - span);
    const to = Math.max(t, rows.first + span);
    const path = sampled(rows, from, t);
    const numbers = path.flat().filter(Number.isFinite);
    const [low, high] = padded(Math.min(...numbers), Math.max(...numbers));
    const frame = framed(context, size, colours, { x: [to - span, to], y: [low, high] });
    facts.coordinates.forEach((name, index) => {
        const colour = colours.series[index % colours.series.length];
        const points = path.map((q, at) => frame(from + ((t - from) * at) / POINTS, q[index]));
        line(context, points, colour, 2);
        disc(context, points.at(-1), 4, colour);
    });
    legend(context, size, facts.coordinates, colours);
}

function legend(context, { width }, names, colours) {
    context.textAlign = 'left';
    context.textBaseline = 'middle';
    let x = 52;
    names.forEach((name, index) => {
        const wide = context.measureText(name).width + 26;
        if (x + wide > width) return;
        disc(context, [x, 12], 4, colours.series[index % colours.series.length]);
        context.fillStyle = colours.ink;
        context.fillText(name, x + 9, 12.5);
        x += wide;
    });
}

function padded(low, high) {
    const room = Math.max(0.08 * (high - low), 1e-6 * Math.max(Math.abs(low), Math.abs(high), 1));
    return [low - room, high + room];
}

// Axes; returns the place of a point. `spelled` writes a number of the vertical axis.
export function framed(context, { width, height }, colours, { x, y, marks, spelled = short }) {
    const [left, right, top, bottom] = [46, width - 12, 24, height - 24];
    const place = (a, b) => [
        left + ((right - left) * (a - x[0])) / (x[1] - x[0]),
        bottom - ((bottom - top) * (b - y[0])) / (y[1] - y[0]),
    ];
    context.fillStyle = colours.quiet;
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    for (const mark of marks ?? ticks(y[0], y[1], 5)) {
        const [, at] = place(x[0], mark);
        line(context, [[left, at], [right, at]], colours.rule, 1);
        context.fillText(spelled(mark), left - 8, at);
    }
    context.textAlign = 'center';
    context.textBaseline = 'top';
    for (const mark of ticks(x[0], x[1], Math.max(2, Math.floor(width / 110)))) {
        const [at] = place(mark, y[0]);
        if (at > left - 1 && at < right - 16) context.fillText(short(mark), at, bottom + 8);
    }
    context.textAlign = 'right';
    context.fillText('t', right, bottom + 8);
    return place;
}
