// A canvas in pixels of the page, with the colours of the style sheet.

const SERIES = ['--series-1', '--series-2', '--series-3', '--series-4', '--series-5', '--series-6'];

// Draws on a canvas: `draw` gets the context, its width and height, and the colours.
export function drawn(canvas, draw) {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width === 0 || height === 0) return;
    const ratio = window.devicePixelRatio || 1;
    const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
    const context = canvas.getContext('2d');
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.lineJoin = context.lineCap = 'round';
    context.font = '12px ui-sans-serif, system-ui, sans-serif';
    draw(context, { width, height }, colours());
}

let known;

function colours() {
    if (!known) {
        const style = getComputedStyle(document.documentElement);
        const of = (name) => style.getPropertyValue(name).trim();
        known = {
            ink: of('--ink'),
            quiet: of('--quiet'),
            rule: of('--rule'),
            own: of('--own'),
            rival: of('--rival'),
            body: of('--body'),
            panel: of('--panel'),
            series: SERIES.map(of),
        };
    }
    return known;
}

matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    known = undefined;
});

export function line(context, points, colour, width = 1.5) {
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.beginPath();
    points.forEach(([x, y], index) => (index ? context.lineTo(x, y) : context.moveTo(x, y)));
    context.stroke();
}

export function disc(context, [x, y], radius, colour) {
    context.fillStyle = colour;
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.fill();
}

// A line that fades toward its first point.
export function trail(context, points, colour, width = 2) {
    const PARTS = 24;
    context.lineCap = 'butt'; // round ones would overlap
    for (let part = 0; part < PARTS; part += 1) {
        const [from, to] = [part, part + 1].map((at) => Math.floor((at / PARTS) * (points.length - 1)));
        context.globalAlpha = ((part + 1) / PARTS) ** 1.6;
        line(context, points.slice(from, to + 1), colour, width);
    }
    context.globalAlpha = 1;
    context.lineCap = 'round';
}

// Round numbers from `low` to `high`, about `count` of them.
export function ticks(low, high, count) {
    const rough = (high - low) / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((of) => of * power).find((of) => of >= rough);
    const all = [];
    for (let index = Math.ceil(low / step); index * step <= high + 1e-9 * step; index += 1) all.push(index * step);
    return all;
}

// A number in few digits.
export function short(value) {
    if (value === 0) return '0';
    const size = Math.abs(value);
    return size >= 1e5 || size < 1e-3 ? value.toExponential(0).replace('e+', 'e') : String(Number(value.toPrecision(4)));
}
