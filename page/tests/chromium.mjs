// A headless Chromium that is driven over a pipe, and a server of static files: no packages are needed.

import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.wasm': 'application/wasm' };

// Serves a folder; returns its address and a function that ends it.
export function served(folder) {
    const server = createServer(async (request, response) => {
        const path = decodeURIComponent(new URL(request.url, 'http://host').pathname);
        const file = join(folder, normalize(path.endsWith('/') ? `${path}index.html` : path));
        try {
            const bytes = await readFile(file);
            response.writeHead(200, { 'Content-Type': TYPES[extname(file)] ?? 'text/plain; charset=utf-8' });
            response.end(bytes);
        } catch {
            response.writeHead(404).end();
        }
    });
    return new Promise((resolve) => {
        server.listen(0, '127.0.0.1', () => {
            resolve({ address: `http://127.0.0.1:${server.address().port}/`, close: () => server.close() });
        });
    });
}

export class Chromium {
    #process;
    #profile = mkdtempSync(join(tmpdir(), 'chromium-'));
    #waiting = new Map();
    #count = 0;
    #session;
    // What scripts of the page have thrown.
    thrown = [];

    static async launch(program, { width, height }) {
        const browser = new Chromium();
        const options = ['--headless', '--no-sandbox', '--disable-gpu', '--hide-scrollbars', '--remote-debugging-pipe'];
        options.push(`--user-data-dir=${browser.#profile}`, `--window-size=${width},${height}`, 'about:blank');
        browser.#process = spawn(program, options, { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
        browser.#read(browser.#process.stdio[4]);
        const { targetInfos } = await browser.send('Target.getTargets');
        const { targetId } = targetInfos.find(({ type }) => type === 'page');
        const { sessionId } = await browser.send('Target.attachToTarget', { targetId, flatten: true });
        browser.#session = sessionId;
        await browser.send('Page.enable');
        await browser.send('Runtime.enable');
        return browser;
    }

    // Messages end with a zero byte.
    #read(pipe) {
        let rest = Buffer.alloc(0);
        pipe.on('data', (bytes) => {
            rest = Buffer.concat([rest, bytes]);
            for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
                this.#take(JSON.parse(rest.subarray(0, end).toString()));
                rest = rest.subarray(end + 1);
            }
        });
    }

    #take({ id, result, error, method, params }) {
        if (method === 'Runtime.exceptionThrown') {
            this.thrown.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
        }
        const waiting = this.#waiting.get(id);
        this.#waiting.delete(id);
        if (waiting && error) waiting.reject(new Error(error.message));
        else waiting?.resolve(result);
    }

    send(method, params = {}) {
        this.#count += 1;
        const message = { id: this.#count, method, params, sessionId: this.#session };
        this.#process.stdio[3].write(`${JSON.stringify(message)}\0`);
        return new Promise((resolve, reject) => this.#waiting.set(message.id, { resolve, reject }));
    }

    async open(address) {
        await this.send('Page.navigate', { url: address });
        await this.until('document.readyState === "complete"');
    }

    // The value of an expression in the page, also of a promise.
    async value(expression) {
        const { result, exceptionDetails } = await this.send('Runtime.evaluate', {
            expression,
            awaitPromise: true,
            returnByValue: true,
        });
        if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
        return result.value;
    }

    // Waits until an expression holds.
    async until(expression, seconds = 60) {
        const stop = Date.now() + 1000 * seconds;
        while (!(await this.value(expression))) {
            if (Date.now() > stop) throw new Error(`${seconds} s without ${expression}`);
            await new Promise((resolve) => setTimeout(resolve, 50));
        }
    }

    async picture() {
        const { data } = await this.send('Page.captureScreenshot', { format: 'png' });
        return Buffer.from(data, 'base64');
    }

    async close() {
        const ended = new Promise((resolve) => this.#process.once('exit', resolve));
        await this.send('Browser.close').catch(() => {});
        await ended;
        rmSync(this.#profile, { recursive: true, force: true, maxRetries: 10, retryDelay: 100 });
    }
}
