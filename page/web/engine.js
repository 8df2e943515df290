// The compiler and the methods: the exports of the WebAssembly with strings, lists and objects.

const encoder = new TextEncoder();
const decoder = new TextDecoder();

// Every text stays compiled, so a page on which much is written begins anew.
const MOST_BYTES = 256 * 2 ** 20;

export class Engine {
    #module;
    #wasm;

    static async load(address) {
        const engine = new Engine();
        const answer = await fetch(address);
        if (!answer.ok) throw new Error(`${address}: ${answer.status}`);
        engine.#module = await WebAssembly.compile(await answer.arrayBuffer());
        await engine.renew();
        return engine;
    }

    // A new instance, also after one that has trapped.
    async renew() {
        this.#wasm = (await WebAssembly.instantiate(this.#module)).exports;
    }

    get isFull() {
        return this.#wasm.memory.buffer.byteLength > MOST_BYTES;
    }

    // { facts } or { mistakes }
    compile(text) {
        const bytes = encoder.encode(text);
        const address = this.#wasm.text_of(bytes.length);
        new Uint8Array(this.#wasm.memory.buffer, address, bytes.length).set(bytes);
        const isRight = this.#wasm.compile();
        const answer = JSON.parse(this.#text());
        return isRight ? { facts: answer } : { mistakes: answer };
    }

    // { h, energy } or { error }. The numbers are all parameters, coordinates and velocities; h = 0 asks for the step
    // whose error is below the tolerance.
    begin(method, h, tolerance, numbers) {
        this.#write(numbers);
        const isRight = this.#wasm.begin(method, h, tolerance);
        return isRight ? JSON.parse(this.#text()) : { error: this.#text() };
    }

    // { rows } of the steps until the time `end`, with { error } if one failed.
    advance(end, most) {
        const isRight = this.#wasm.advance(end, most);
        const count = this.#wasm.numbers_length();
        const rows = new Float64Array(this.#wasm.memory.buffer, this.#wasm.numbers_of(count), count).slice();
        return isRight ? { rows } : { rows, error: this.#text() };
    }

    // Takes steps of another run for their time; false if one failed.
    measure(method, h, numbers, steps) {
        this.#write(numbers);
        return Boolean(this.#wasm.measure(method, h, steps));
    }

    #write(numbers) {
        const address = this.#wasm.numbers_of(numbers.length);
        new Float64Array(this.#wasm.memory.buffer, address, numbers.length).set(numbers);
    }

    #text() {
        const length = this.#wasm.text_length();
        return decoder.decode(new Uint8Array(this.#wasm.memory.buffer, this.#wasm.text_of(length), length));
    }
}
