//! Systems of a file, without a crate.

use super::sweep::Folder;
use super::{assert_refused, lab, rows, success};

const OWN: &str = "
/// A pendulum on a cart.
struct Own {
    param m = 0.4, l = 0.6;
    coord x, a;
    L = dot(x)^2 / 2 + m * ((dot(x) + l * cos(a) * dot(a))^2 + (l * sin(a) * dot(a))^2) / 2 + 9.81 * m * l * cos(a);
    discretize midpoint;
    check { x = 0, a = 1, m = 0.5; h = 0.01; }
}
";

#[test]
fn a_system_of_a_file_runs() {
    let folder = Folder::new("own", "");
    let bare = folder.file("own.vi", OWN);
    let of_rust = folder.file("own.rs", &format!("use vi_core::lagrangian;\nlagrangian! {{ {OWN} }}\n"));
    let options = ["--method", "gauss", "--until", "2", "--every", "50"];
    let rows = |file: &str| {
        let (status, output, errors) = lab(&[&["run", file], &options[..]].concat());
        assert_eq!(status, Some(0), "{errors}");
        assert!(output.contains("# parameters: m = 0.5, l = 0.6\n"), "those of its check: {output}");
        output.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect::<Vec<_>>()
    };
    let found = rows(&bare);
    assert_eq!(found, rows(&of_rust));
    assert_eq!(found[0], "t,x,a,p_x,p_a,H,E,h");
    assert!(found[1].starts_with("0.0,0.0,1.0,0.0,0.0,") && found.len() == 6, "{found:?}");
    let energies = found[1..].iter().map(|row| row.split(',').nth(5).expect("H").parse::<f64>().expect("a number"));
    let energies: Vec<f64> = energies.collect();
    assert!(energies.iter().all(|energy| (energy - energies[0]).abs() < 1e-13), "{energies:?}");
    let (status, output, errors) = lab(&["explain", &bare]);
    assert!(status == Some(0) && output.starts_with("Own\n"), "{errors}");
}

#[test]
fn a_text_is_swept() {
    let folder = Folder::new("swept", "");
    let own = folder.file("own.vi", OWN);
    let scene = format!("system = {own:?}\nsteps = 20\n[sweep]\nover = [{{ name = \"a\", values = [0.5, 1.0] }}]\n");
    let (status, output, errors) = lab(&["sweep", &folder.file("scene.toml", &scene), "-o", &folder.at("out.csv")]);
    assert!(status == Some(0) && output.contains("2 runs, all reached their end"), "{output} {errors}");
}

#[test]
fn a_text_with_constraints_and_a_table_runs() {
    let folder = Folder::new("bound", "");
    let table = folder.file("pull.csv", "x,f\n-2,0.3\n0,0\n2,-0.3\n");
    let text = format!(
        "struct Rod {{ coord x, y; table pull(x) = {table:?}; L = (dot(x)^2 + dot(y)^2) / 2 - 9.81 * y;
         constraint rod = x^2 + y^2 - 1; force x = pull(x); check {{ x = 0.6, y = -0.8; h = 0.01; }} }}"
    );
    let (status, output, errors) = lab(&["run", &folder.file("rod.vi", &text), "--steps", "20", "--every", "20"]);
    assert_eq!(status, Some(0), "{errors}");
    let last = output.lines().last().expect("a row").split(',').map(|cell| cell.parse::<f64>().expect("a number"));
    let last: Vec<f64> = last.collect();
    assert!((last[1].hypot(last[2]) - 1.0).abs() < 1e-15 && last[1] < 0.55, "{last:?}");
}

#[test]
fn a_text_is_studied() {
    let folder = Folder::new("studied", "");
    let own = folder.file("own.vi", OWN);
    let (status, output, errors) = lab(&["lyapunov", &own, "--count", "4", "--steps", "200"]);
    assert_eq!(status, Some(0), "{errors}");
    let last = output.lines().last().expect("a row").split(',').map(|cell| cell.parse::<f64>().expect("a number"));
    let last: Vec<f64> = last.collect();
    // Volumes of the phase space stay.
    assert!(last.len() == 5 && last[1..].iter().sum::<f64>().abs() < 1e-5 && last[1] > 0.05, "{last:?}");
}

#[test]
fn a_wrong_file_says_where() {
    let folder = Folder::new("wrong", "");
    let wrong = folder.file("wrong.vi", &OWN.replace("m * l * cos(a)", "m * r * cos(a)"));
    let (status, output, errors) = lab(&["run", &wrong]);
    assert!(status == Some(1) && output.is_empty(), "{errors}");
    assert!(errors.contains("unknown name `r`") && errors.contains("wrong.vi:6:"), "{errors}");
    let (status, _, errors) = lab(&["run", &folder.at("none.vi")]);
    assert!(status == Some(2) && errors.contains("none.vi"), "{errors}");
}

#[test]
fn constraints_that_follow_from_the_others_are_left_out() {
    let folder = Folder::new("drop", "");
    let bars = folder.file(
        "bars.vi",
        "struct Bars {
            coord x, y, u, w;
            L = (dot(x)^2 + dot(y)^2 + dot(u)^2 + dot(w)^2) / 2 - 9.81 * (y + w);
            constraint left = x^2 + y^2 - 1, right = (u - 2)^2 + w^2 - 1, coupler = (u - x)^2 + (w - y)^2 - 4;
            constraint middle = ((x + u) / 2 - 1)^2 + ((y + w) / 2)^2 - 1;
            check { x = 0.6, y = -0.8, u = 2.6, w = -0.8; h = 0.01; }
        }",
    );
    let (status, _, errors) = lab(&["run", &bars, "--steps", "3"]);
    assert!(status == Some(1) && errors.contains("otherwise leave it out with --drop 'middle'"), "{errors}");
    // At a dead point the mechanism needs the constraint that follows from the others there.
    let dead = ["run", &bars, "--drop", "middle", "--q", "1,0,3,0", "--v", "0,0,0,0", "--steps", "3"];
    let (status, _, errors) = lab(&dead);
    let elsewhere = "what to do: start elsewhere with --q if bars are in one line, where several motions may begin; ";
    assert!(status == Some(1) && errors.contains(elsewhere), "{errors}");
    let csv = success(&["run", &bars, "--drop", "middle", "--steps", "20", "--every", "20"]);
    // t, q, p, Λ of each constraint, the residual of all.
    let last = &rows(&csv)[1];
    assert!(last[12].abs() <= 0.0 && last[13] < 1e-14, "{csv}");
    assert!((last[1] - last[3] + 2.0).abs() < 1e-14 && (last[1] - 0.6).abs() > 0.05, "{csv}");
    assert_refused(&[
        (
            &["run", &bars, "--drop", "top"],
            "bars has no constraint `top` to --drop; it has left, right, coupler, middle",
        ),
        (
            &["run", "rod-chain", "--drop", "rod[0]"],
            "rod-chain is compiled and keeps all its constraints; give its file, .vi or .rs, with --drop",
        ),
    ]);
}
