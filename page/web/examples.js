// The examples, and how their motion is drawn.
//
// `span` is the time that the window of a chart shows; ten seconds pass meanwhile. A scene is drawn if the system has the
// name of the example, its coordinates and the parameters that the scene needs.

const arms = (list) => ({ arms: list });
const bodies = (list, sun) => ({ bodies: list, sun });

export const EXAMPLES = [
    { id: 'pendulum', name: 'Pendulum', title: 'Pendulum', span: 10, scene: arms([['θ', 'l', 'm']]) },
    {
        id: 'double_pendulum',
        name: 'DoublePendulum',
        title: 'Double pendulum',
        span: 10,
        scene: arms([['θ1', 'l1', 'm1'], ['θ2', 'l2', 'm2']]),
    },
    { id: 'kepler', name: 'Kepler', title: 'Kepler', span: 12, scene: bodies([['x', 'y']], true) },
    {
        id: 'figure_eight',
        name: 'FigureEight',
        title: 'Three bodies',
        span: 10,
        scene: bodies([0, 1, 2].map((body) => [`r[${body}][0]`, `r[${body}][1]`]), false),
    },
];

// The scene of a system with places of coordinates and parameters in its facts, and the span; none if it is no example.
export function sceneOf({ name, coordinates, parameters }) {
    const example = EXAMPLES.find((of) => of.name === name);
    if (!example) return undefined;
    const { span, scene } = example;
    const place = (name) => coordinates.indexOf(name);
    const parameter = (name) => parameters.findIndex((of) => of.name === name);
    const found = scene.arms
        ? { arms: scene.arms.map(([angle, length, mass]) => [place(angle), parameter(length), parameter(mass)]) }
        : { bodies: scene.bodies.map((pair) => pair.map(place)), sun: scene.sun };
    const places = (found.arms ?? found.bodies).flat();
    return places.includes(-1) ? undefined : { ...found, span };
}

export async function textOf(example) {
    const answer = await fetch(`examples/${example.id}.txt`);
    if (!answer.ok) throw new Error(`${example.id}: ${answer.status}`);
    return (await answer.text()).trimEnd();
}
