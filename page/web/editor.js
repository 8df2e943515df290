// The text with its colours, and its mistakes at their tokens.

const TOKENS = new RegExp(
    [
        String.raw`(?<comment>\/\/[^\n]*|\/\*[\s\S]*?\*\/)`,
        String.raw`(?<string>"[^"\n]*"?)`,
        String.raw`(?<number>\b\d[\d_]*(?:\.\d+)?(?:[eE][+-]?\d+)?)`,
        String.raw`(?<word>[\p{L}_][\p{L}\p{N}_]*)`,
    ].join('|'),
    'gu',
);
const CLAUSES = new Set(
    'pub struct const param input coord angle rotation momentum let L H force torque space_torque dissipation time_scale constraint table fn discretize check if else in'.split(' '),
);
const FUNCTIONS = new Set(
    'dot sum sin cos tan asin acos atan atan2 sinh cosh tanh exp ln sqrt abs sign hypot norm cross transpose max min clamp pi'.split(' '),
);

export class Editor {
    #text;
    #shown;
    #list;
    #marks = [];

    constructor(text, shown, list, changed) {
        [this.#text, this.#shown, this.#list] = [text, shown, list];
        text.addEventListener('input', () => {
            this.#marks = [];
            this.#paint();
            changed();
        });
    }

    get text() {
        return this.#text.value;
    }

    set text(text) {
        this.#text.value = text;
        this.#marks = [];
        this.#paint();
    }

    // Shows the mistakes of the text, or none.
    show(mistakes) {
        const each = mistakes?.each ?? [];
        this.#marks = each.map(({ from, to }) => marked(this.text, from, to));
        this.#paint();
        this.#text.setAttribute('aria-invalid', String(mistakes !== undefined));
        const entries = each.map((mistake, index) => this.#entry(mistake, this.#marks[index]));
        if (mistakes && entries.length === 0) entries.push(element('pre', 'whole', mistakes.text));
        this.#list.replaceChildren(...entries);
    }

    #entry({ wrong, helps, from: [line] }, [begin, end]) {
        const entry = element('button', 'mistake');
        entry.type = 'button';
        entry.append(element('span', 'place', `line ${line}`), element('span', 'what', ...coded(wrong)));
        for (const help of helps.split('\n').filter(Boolean)) {
            entry.append(element('span', 'help', ...coded(help.replace(/^help: /, ''))));
        }
        entry.addEventListener('click', () => {
            this.#text.focus();
            this.#text.setSelectionRange(begin, end);
        });
        return entry;
    }

    #paint() {
        this.#shown.replaceChildren(...painted(this.text, this.#marks));
    }
}

export function element(name, className, ...content) {
    const made = document.createElement(name);
    made.className = className;
    made.append(...content);
    return made;
}

// Words of a message, with code between backticks.
function coded(words) {
    return words.split('`').map((part, index) => (index % 2 ? element('code', '', part) : part));
}

// The place of a token in the text, from lines that count from 1 and columns in characters; at least one character.
function marked(text, from, to) {
    const place = ([line, column]) => {
        const before = text.split('\n').slice(0, line - 1);
        const letters = Array.from(text.split('\n')[line - 1] ?? '').slice(0, column);
        return Math.min(text.length, before.join('\n').length + (before.length ? 1 : 0) + letters.join('').length);
    };
    const begin = place(from);
    return [begin, Math.max(place(to), begin + 1)];
}

// The text in pieces of one colour, those of mistakes underlined.
function painted(text, marks) {
    const pieces = [];
    let done = 0;
    const push = (end, kind) => {
        const cuts = marks.flat().filter((cut) => cut > done && cut < end).sort((a, b) => a - b);
        for (const stop of [...cuts, end]) {
            if (stop === done) continue;
            const isWrong = marks.some(([from, to]) => from <= done && stop <= to);
            const words = text.slice(done, stop);
            pieces.push(kind || isWrong ? element('span', `${kind}${isWrong ? ' wrong' : ''}`, words) : words);
            done = stop;
        }
    };
    for (const token of text.matchAll(TOKENS)) {
        push(token.index, '');
        push(token.index + token[0].length, kindOf(token.groups));
    }
    push(text.length, '');
    // A mistake behind the last character, and a last line that is empty, need something to show.
    const isBehind = marks.some(([, to]) => to > text.length);
    return [...pieces, element('span', isBehind ? 'wrong' : '', '\u200b ')];
}

function kindOf({ comment, string, number, word }) {
    if (comment) return 'comment';
    if (number) return 'number';
    if (string) return 'string';
    if (CLAUSES.has(word)) return 'clause';
    return FUNCTIONS.has(word) ? 'function' : '';
}
