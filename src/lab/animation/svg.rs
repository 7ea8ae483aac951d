//! The animation as an SVG that moves by itself (SMIL), and as a page around it with a pause button.

use super::{Animation, Track, coils, share};
use crate::text::number::short;
use std::fmt::Write;

const ROW: f64 = 76.0;
const HEAD: f64 = 44.0;
const WIDTH: f64 = 960.0;
/// Position of the wall to which the springs are attached, and the range of the masses' positions.
const WALL: f64 = 210.0;
const TRACK: (f64, f64) = (260.0, 760.0);
/// Left edge and size of the phase planes.
const PLANE: (f64, f64) = (830.0, 66.0);
/// Length of a spring as drawn, before it is scaled.
const SPRING: f64 = 100.0;

const STYLE: &str = "\
text{font:14px system-ui,sans-serif;fill:#26262c}.r{fill:#fff}.w{stroke:#5c5c66;stroke-width:2}\
.k{fill:none;stroke:#8a8a94;stroke-width:1.3;vector-effect:non-scaling-stroke}.p{fill:none;stroke-width:1;opacity:.55}\
.f{fill:none;stroke:#c8c8d0}.m{fill:#fff;stroke-width:4}\
.t{stroke:#26262c}.s0{stroke:#0072b2}.s1{stroke:#d55e00}.s2{stroke:#009e73}.s3{stroke:#cc79a7}.s4{stroke:#e69f00}.s5{stroke:#56b4e9}\
@media(prefers-color-scheme:dark){text{fill:#e8e8ec}.r,.m{fill:#17181c}.t{stroke:#e8e8ec}.f{stroke:#4a4b55}.s0{stroke:#4ea6e6}.s1{stroke:#ff8a3d}}";

/// The SVG document.
pub fn svg(animation: &Animation) -> String {
    let height = HEAD + ROW * animation.tracks.len() as f64 + 6.0;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" \
         aria-label=\"Masses on springs, moved by different methods\"><style>{STYLE}</style>\
         <rect class=\"r\" width=\"{WIDTH}\" height=\"{height}\"/>\
         <text x=\"16\" y=\"26\">steps of {} s</text><text x=\"{}\" y=\"20\">position over</text>\
         <text x=\"{}\" y=\"37\">velocity</text>\n",
        short(animation.h),
        PLANE.0 - 12.0,
        PLANE.0 - 12.0
    );
    for (n, track) in animation.tracks.iter().enumerate() {
        row(&mut svg, animation, track, n);
    }
    svg + "</svg>\n"
}

/// A page with the SVG and a button. If the reader has requested reduced motion, the animation starts only by the
/// button.
pub fn html(animation: &Animation) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>Masses on springs</title>\n\
         <style>body{{max-width:70rem;margin:1rem auto;padding:0 1rem;font:1rem/1.5 system-ui,sans-serif}}\
         button{{font:inherit;padding:.2rem 1rem}}svg{{width:100%;height:auto}}</style>\n</head>\n<body>\n\
         <h1>Masses on springs</h1>\n<p><button type=\"button\" id=\"hold\">Pause</button></p>\n{}\
         <script>\nconst svg = document.querySelector(\"svg\"), button = document.getElementById(\"hold\");\n\
         function hold(on) {{ on ? svg.pauseAnimations() : svg.unpauseAnimations(); \
         button.textContent = on ? \"Play\" : \"Pause\"; }}\n\
         button.addEventListener(\"click\", () => hold(!svg.animationsPaused()));\n\
         if (matchMedia(\"(prefers-reduced-motion: reduce)\").matches) hold(true);\n</script>\n</body>\n</html>\n",
        svg(animation)
    )
}

fn row(svg: &mut String, animation: &Animation, track: &Track, n: usize) {
    let y = HEAD + ROW * (n as f64 + 0.5);
    let class = track.series.map_or("t".to_owned(), |series| format!("s{}", series % 6));
    let seconds = animation.len() as f64 / animation.rate;
    let places: Vec<(f64, bool)> = track.frames.iter().map(|state| animation.place(state.x)).collect();
    let across = |place: f64| TRACK.0 + place * (TRACK.1 - TRACK.0);
    let list = |value: &dyn Fn(usize) -> String| (0..places.len()).map(value).collect::<Vec<_>>().join(";");
    let clock = format!("dur=\"{seconds}s\" repeatCount=\"indefinite\"");
    let spring: String = coils(SPRING, 9.0).iter().map(|(x, side)| format!("{x:.1},{side} ")).collect();
    // Writing to a string cannot fail.
    let _ = write!(
        svg,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text><path class=\"w\" d=\"M{WALL} {}V{}\"/>\
         <g transform=\"translate({WALL} {y})\"><polyline class=\"k\" points=\"{}\">\
         <animateTransform attributeName=\"transform\" type=\"scale\" {clock} values=\"{}\"/></polyline></g>",
        WALL - 14.0,
        y + 5.0,
        track.title,
        y - 22.0,
        y + 22.0,
        spring.trim_end(),
        list(&|n| format!("{:.3} 1", (across(places[n].0) - 14.0 - WALL) / SPRING)),
    );
    let _ = write!(
        svg,
        "<rect class=\"m {class}\" x=\"-14\" y=\"{}\" width=\"28\" height=\"28\" rx=\"4\">\
         <animateTransform attributeName=\"transform\" type=\"translate\" {clock} values=\"{}\"/>\
         <animate attributeName=\"opacity\" calcMode=\"discrete\" {clock} values=\"{}\"/></rect>",
        y - 14.0,
        list(&|n| format!("{:.1} 0", across(places[n].0))),
        list(&|n| if places[n].1 { "1".to_owned() } else { "0.3".to_owned() }),
    );
    let corner = y - 0.5 * PLANE.1;
    let point = |x: f64, v: f64| {
        let ((right, a), (up, b)) = (share(v, &animation.v), share(x, &animation.x));
        (PLANE.0 + right * PLANE.1, corner + (1.0 - up) * PLANE.1, a && b)
    };
    let trail: String = track
        .path
        .iter()
        .map(|state| point(state.x, state.v))
        .take_while(|(_, _, inside)| *inside)
        .map(|(x, y, _)| format!("{x:.1},{y:.1} "))
        .collect();
    let dots: Vec<(f64, f64, bool)> = track.frames.iter().map(|state| point(state.x, state.v)).collect();
    let _ = writeln!(
        svg,
        "<rect class=\"f\" x=\"{}\" y=\"{corner}\" width=\"{}\" height=\"{}\"/>\
         <polyline class=\"p {class}\" points=\"{}\"/><circle class=\"m {class}\" r=\"3\">\
         <animate attributeName=\"cx\" {clock} values=\"{}\"/><animate attributeName=\"cy\" {clock} values=\"{}\"/></circle>",
        PLANE.0,
        PLANE.1,
        PLANE.1,
        trail.trim_end(),
        list(&|n| format!("{:.1}", dots[n].0)),
        list(&|n| format!("{:.1}", dots[n].1)),
    );
}

#[cfg(test)]
mod tests {
    use super::super::tests::comparison;
    use super::*;

    #[test]
    fn every_mass_moves_and_nothing_is_fetched() {
        let animation = Animation::new(&comparison(), 25.0).unwrap();
        let svg = svg(&animation);
        assert_eq!(svg.matches("type=\"translate\"").count(), 3);
        assert_eq!(svg.matches("attributeName=\"cx\"").count(), 3);
        assert!(svg.contains("explicit Euler") && svg.contains("dur=\"1s\""));
        let values = svg.split("type=\"translate\"").nth(1).unwrap().split("values=\"").nth(1).unwrap();
        assert_eq!(values.split('"').next().unwrap().split(';').count(), 25);
        let page = html(&animation);
        assert!(page.contains(&svg) && !page.contains("src="));
    }
}
