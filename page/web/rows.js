// The rows of a run: its last part for the motion, and the errors of all of it.

// Numbers of a row beside coordinates and velocities: the time, and two errors.
const BESIDE = 3;
const MOST_ROWS = 30_000;
const MOST_BINS = 1200; // even

export class Rows {
    #numbers = new Float64Array(0);
    #length = 0;

    constructor(size, start) {
        this.size = size;
        this.stride = 2 * size + BESIDE;
        this.errors = new Errors();
        this.push(start);
    }

    push(numbers) {
        for (let at = 0; at < numbers.length; at += this.stride) {
            const end = at + this.stride;
            this.errors.push(numbers[at], numbers[end - 2], numbers[end - 1]);
        }
        if (this.#length + numbers.length > this.#numbers.length) this.#grow(numbers.length);
        this.#numbers.set(numbers, this.#length);
        this.#length += numbers.length;
    }

    // Keeps the last rows only, so that a run may last for hours.
    #grow(more) {
        const kept = Math.min(this.#length, (MOST_ROWS / 2) * this.stride);
        const larger = new Float64Array(Math.max(2 * (kept + more), 1024));
        larger.set(this.#numbers.subarray(this.#length - kept, this.#length));
        this.#numbers = larger;
        this.#length = kept;
    }

    get first() {
        return this.#numbers[0];
    }

    get last() {
        return this.#numbers[this.#length - this.stride];
    }

    // The coordinates at a time, by the cubic polynomial with the velocities of two rows.
    at(t) {
        const { size, stride } = this;
        const time = (row) => this.#numbers[row * stride];
        let [low, high] = [0, this.#length / stride - 1];
        while (high - low > 1) {
            const middle = (low + high) >> 1;
            if (time(middle) <= t) low = middle;
            else high = middle;
        }
        const number = (row, at) => this.#numbers[row * stride + at];
        const h = time(high) - time(low);
        const s = h > 0 ? Math.min(1, Math.max(0, (t - time(low)) / h)) : 0;
        const [a, b] = [(1 + 2 * s) * (1 - s) ** 2, s * s * (3 - 2 * s)];
        const [c, d] = [h * s * (1 - s) ** 2, h * s * s * (s - 1)];
        return Array.from({ length: size }, (_, index) => {
            const [q, v] = [1 + index, 1 + size + index];
            return a * number(low, q) + b * number(high, q) + c * number(low, v) + d * number(high, v);
        });
    }
}

// The least and the largest of each error in bins of equal numbers of steps, which double when there are too many.
export class Errors {
    bins = [];
    begin;
    #steps = 1;
    #taken = 0;

    push(t, own, rival) {
        const last = this.bins.at(-1);
        this.begin ??= t;
        if (!last || this.#taken >= this.#steps) {
            this.bins.push({ t, own: [own, own], rival: [rival, rival] });
            this.#taken = 1;
        } else {
            last.t = t;
            last.own = widened(last.own, [own, own]);
            last.rival = widened(last.rival, [rival, rival]);
            this.#taken += 1;
        }
        if (this.bins.length > MOST_BINS) this.#halve();
    }

    #halve() {
        const halves = [];
        for (let at = 0; at + 1 < this.bins.length; at += 2) {
            const [a, b] = this.bins.slice(at, at + 2);
            halves.push({ t: b.t, own: widened(a.own, b.own), rival: widened(a.rival, b.rival) });
        }
        // The last one has one step: an even number of others was full.
        halves.push(this.bins.at(-1));
        this.bins = halves;
        this.#steps *= 2;
    }
}

// NaN stays: a rival that has diverged has no error.
function widened([low, high], [least, most]) {
    return [Math.min(low, least), Math.max(high, most)];
}
