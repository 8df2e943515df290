// The command to study the systems of the library: `run`, `explain`, `stability`, `work-precision`, `lyapunov`.

use mine::SpringPendulum;

vi_lab::main! {
    sources: ["lib.rs"],
    systems: [
        SpringPendulum { about: "a swinging mass on a spring", q: [1.2, 0.8], v: [0.0, 0.0], h: 0.01 },
    ],
}
