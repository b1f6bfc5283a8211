//! Pages and pictures: their numbers are those of the JSON, they load nothing, they move in a browser.
#![cfg(feature = "page")]

mod command;

use std::fs;
use std::path::Path;
use std::process::Command;

use command::{Folder, linkwear};
use serde_json::Value;

const RSSR: &str = "mechanisms/rssr.toml";

/// The data that a page holds under a name.
fn data(page: &str, id: &str) -> Value {
    let head = format!("<script type=\"application/json\" id=\"{id}\">");
    let rest = page.split_once(&head).expect("the data").1;
    serde_json::from_str(rest.split_once("</script>").expect("an end").0).expect("JSON")
}

fn page_of(words: &[&str], name: &str) -> (Folder, String) {
    let folder = Folder::new(name);
    let out = folder.path("page.html");
    let told = linkwear(&[words, &["-o", &out, "--format", "json"]].concat()).json();
    let page = folder.read("page.html");
    assert_eq!(told["bytes"], page.len());
    (folder, page)
}

#[test]
fn numbers_of_a_report_are_those_of_simulate_and_life() {
    let (_folder, page) = page_of(&["report", RSSR, "--trajectories", "50", "--seed", "3"], "pages-numbers");
    let life = linkwear(&["life", RSSR, "--trajectories", "50", "--seed", "3", "--format", "json"]).json();
    assert_eq!(data(&page, "life"), life);
    let mut here = data(&page, "simulation");
    let mut there = linkwear(&["simulate", RSSR, "--samples", "721", "--format", "json"]).json();
    for json in [&mut here, &mut there] {
        json["wall_seconds"] = Value::Null;
    }
    assert_eq!(here, there);
    assert!(page.contains("<td>c_rocker</td><td>2 N m s/rad</td><td>assumed, tunable</td>"));
}

#[test]
fn a_page_loads_nothing_and_is_small() {
    let (_folder, page) = page_of(&["report", "mechanisms/four_bar_wear.toml", "--mean"], "pages-network");
    let foreign = page.replace("http://www.w3.org/2000/svg", "");
    for word in
        ["http:", "https:", " src=", " href=", "@import", "url(", "fetch(", "XMLHttpRequest", "import("]
    {
        assert!(!foreign.contains(word), "{word}");
    }
    assert!(page.len() < 2_000_000, "{}", page.len());
}

#[test]
fn every_shipped_mechanism_can_be_looked_at() {
    let folder = Folder::new("pages-all");
    for entry in fs::read_dir("mechanisms").expect("a folder") {
        let file = entry.expect("an entry").path();
        if file.extension().is_none_or(|end| end != "toml") {
            continue;
        }
        let file = file.to_str().expect("UTF-8");
        for (words, out) in [("view", "view.html"), ("draw", "drawing.svg")] {
            let answer = linkwear(&[words, file, "-o", &folder.path(out)]);
            assert_eq!(answer.code, 0, "{file}: {}", answer.err);
            let text = folder.read(out);
            let is_drawn = words == "view" || !text.contains("NaN");
            assert!(text.len() < 3_000_000 && is_drawn, "{words} {file}: {}", text.len());
        }
    }
}

#[test]
fn only_what_linkwear_made_is_replaced() {
    let folder = Folder::new("pages-foreign");
    let out = folder.path("mine.html");
    fs::write(&out, "mine").expect("a file");
    let refused = linkwear(&["view", RSSR, "-o", &out]);
    assert_eq!((refused.code, folder.read("mine.html").as_str()), (1, "mine"), "{}", refused.err);
    for words in [&["--force"][..], &[]] {
        assert_eq!(linkwear(&[&["view", RSSR, "-o", &out], words].concat()).code, 0);
    }
}

#[test]
fn charts_are_drawn_of_runs_lives_and_fits() {
    let folder = Folder::new("pages-plots");
    let out = folder.path("plot.svg");
    let fit = [
        "fit",
        "examples/data/sliding_wear_100g.csv",
        "--unit",
        "unit",
        "--wear",
        "wear_um",
        "--exposure",
        "cycles",
    ];
    let asked: [(&[&str], usize); 3] =
        [(&["simulate", RSSR], 8), (&["life", RSSR], 5), (&[&fit[..], &["--from-zero"]].concat(), 3)];
    for (words, charts) in asked {
        let answer = linkwear(&[words, &["--plot", &out]].concat());
        assert_eq!(answer.code, 0, "{}", answer.err);
        let text = folder.read("plot.svg");
        assert_eq!(text.matches("class=\"title\"").count(), charts, "{words:?}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{words:?}");
    }
}

#[test]
fn what_has_no_life_shows_its_motion_and_loads() {
    // Without clearance and driven along its legs; wear on what nothing turns, so that no revolutions can be counted; no driver.
    let folder = Folder::new("pages-no-life");
    let worn = folder.path("worn.toml");
    let slides = fs::read_to_string("mechanisms/slider_crank_clearance.toml").expect("a mechanism");
    let pushed = slides.replace(", drive = \"2*pi*speed*t\"", "");
    assert_ne!(pushed, slides);
    let wear = "\n[wear.slider_pin]\ncoefficient = 1e-8\nhardness = \"1 GPa\"\nthreshold = \"0.1 mm\"\narea = \"hertz\"\nrevolutions_per_cycle = 1e5\n";
    fs::write(&worn, pushed + wear).expect("a file");
    let shipped =
        ["tests/data/stewart.toml", "mechanisms/pendulum.toml", "mechanisms/slider_crank_clearance.toml"];
    for file in shipped.into_iter().chain([&*worn]) {
        let (_folder, page) = page_of(&["report", file], "pages-no-life-of");
        assert_eq!(data(&page, "life"), Value::Null, "{file}");
        assert!(page.contains("<h2>Loads</h2>") && page.contains("<h2>Curves</h2>"), "{file}");
        assert!(!page.contains("<h2>Life</h2>"), "{file}");
    }
}

#[test]
fn pictures_are_png_by_their_feature_or_say_how_to_get_it() {
    let folder = Folder::new("pages-png");
    let out = folder.path("x.png");
    for words in [&["draw", RSSR, "-o", &out][..], &["simulate", RSSR, "--plot", &out]] {
        let answer = linkwear(words);
        if cfg!(feature = "png") {
            assert_eq!(answer.code, 0, "{}", answer.err);
            let bytes = fs::read(&out).expect("a picture");
            assert!(bytes.starts_with(b"\x89PNG") && bytes.len() > 10_000, "{}", bytes.len());
        } else {
            assert!(answer.code == 2 && answer.err.contains("--features png"), "{}", answer.err);
            assert!(!fs::exists(&out).unwrap_or(true));
        }
    }
}

/// What a page does by itself, told in its title: pixels that differ and change, controls that act, no request.
const TRIAL: &str = r#"<script>
addEventListener("error", event => { document.title = "error: " + event.message; });
addEventListener("load", () => setTimeout(() => {
  const $ = id => document.getElementById(id), canvas = $("view"), { state, camera, draw } = window.linkwear;
  const picture = () => { draw(); const gl = canvas.getContext("webgl2") || canvas.getContext("webgl"), p = new Uint8Array(4 * canvas.width * canvas.height); gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, p); return p; };
  const kinds = p => { const seen = new Set(); for (let i = 0; i < p.length; i += 4) seen.add(p[i] << 16 | p[i + 1] << 8 | p[i + 2]); return seen.size; };
  const differ = (p, q) => { let n = Math.abs(p.length - q.length); for (let i = 0; i < p.length; i += 4) n += p[i] !== q[i] || p[i + 1] !== q[i + 1]; return n; };
  const set = (id, value) => { $(id).value = value; $(id).dispatchEvent(new Event("input", { bubbles: true })); };
  const press = (key, to) => to.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  const results = [], say = (what, is) => results.push((is ? "ok " : "FAILED ") + what);
  const first = picture();
  say("colours", kinds(first) > 15);
  // A browser that draws little by little has its time.
  const watch = tries => {
    const moves = differ(first, picture()) > 100;
    if (!moves && tries > 0) return setTimeout(() => watch(tries - 1), 100);
    say("moves", moves);
    $("play").click();
    const t = state.t;
    setTimeout(() => {
      say("pauses", !state.playing && state.t === t);
      press(" ", document.body);
      say("space", state.playing);
      press(" ", document.body);
      const [slow, gap] = [state.slow, state.gap], before = picture();
      set("slow", 2.5);
      set("gap", 3.7);
      say("slow motion", state.slow !== slow);
      say("exaggerates", state.gap !== gap && differ(before, picture()) > 10);
      const { yaw, distance: far } = camera;
      canvas.focus();
      for (const key of ["ArrowLeft", "+", "."]) press(key, canvas);
      say("keys", camera.yaw !== yaw && camera.distance < far && state.t > t);
      const turned = picture();
      say("turned", differ(before, turned) > 100);
      const chart = document.querySelector("svg[data-time]"), box = chart.getBoundingClientRect(), mark = () => chart.querySelector(".cursor").getAttribute("transform");
      chart.scrollIntoView();
      chart.dispatchEvent(new PointerEvent("pointermove", { clientX: box.left + box.width / 2, clientY: box.top + 50, bubbles: true }));
      say("curves", state.t > 0.3 * 0.5 && state.t < 0.7 * 0.5 && differ(turned, picture()) > 100);
      const orbit = $("bearings").querySelector("canvas");
      if (orbit) say("orbit", kinds(orbit.getContext("2d").getImageData(0, 0, orbit.width, orbit.height).data) > 5);
      const columns = $("column"), chosen = option => { columns.value = option.value; columns.dispatchEvent(new Event("change")); return [...$("chosen").querySelectorAll("text")]; };
      say("whole labels", ![...columns.options].some(option => chosen(option).some(text => text.getBBox().x < 0)));
      say("no request", performance.getEntriesByType("resource").length === 0);
      document.title = results.join("; ");
    }, 300);
  };
  setTimeout(() => watch(30), 600);
}, 600));
</script>"#;

/// The title that a page has given itself in Chromium, and what its console says.
fn tried(file: &str, more: &[&str]) -> (String, Vec<String>) {
    let file = Path::new(file).canonicalize().expect("a path");
    let words = [
        "--headless",
        "--no-sandbox",
        "--enable-unsafe-swiftshader",
        "--enable-logging=stderr",
        "--window-size=1280,720",
        "--virtual-time-budget=9000",
        "--dump-dom",
    ];
    let output =
        Command::new("chromium").args(words).args(more).arg(format!("file://{}", file.display())).output();
    let output = output.expect("chromium runs");
    let [dom, log] = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    let title = dom.split_once("<title>").and_then(|(_, rest)| rest.split_once("</title>"));
    // What the driver says of reading pixels back is no error of the page.
    let said = log.lines().filter(|line| line.contains("CONSOLE") && !line.contains("GL Driver Message"));
    (title.expect("a title").0.to_owned(), said.map(str::to_owned).collect())
}

#[test]
#[ignore = "needs a browser: apt-get install chromium"]
fn a_page_moves_in_a_browser() {
    let (folder, page) = page_of(&["report", RSSR, "--trajectories", "20"], "pages-browser");
    let place = folder.path("tried.html");
    fs::write(&place, page + TRIAL).expect("a file");
    let (title, said) = tried(&place, &[]);
    let parts: Vec<&str> = title.split("; ").collect();
    assert!(parts.len() >= 12 && parts.iter().all(|part| part.starts_with("ok ")), "{title}");
    assert_eq!(said, Vec::<String>::new());
}

/// A page in a frame as wide as a phone, whose title says how wide what is in it is, and of which colour its paper.
const PHONE: &str = r#"<!doctype html><title></title><iframe id="phone" style="width:420px;height:850px;border:0"></iframe><script>
const frame = document.getElementById("phone");
frame.srcdoc = PAGE;
frame.addEventListener("load", () => setTimeout(() => {
  const inside = frame.contentDocument, paper = getComputedStyle(inside.body).backgroundColor.match(/\d+/g).map(Number);
  document.title = `${inside.documentElement.scrollWidth <= 420 ? "fits" : "scrolls " + inside.documentElement.scrollWidth}, ${paper[0] < 60 ? "dark" : "light"}`;
}, 800));
</script>"#;

#[test]
#[ignore = "needs a browser: apt-get install chromium"]
fn a_page_fits_a_phone_and_follows_its_colours() {
    let (folder, page) = page_of(&["report", RSSR, "--mean"], "pages-phone");
    let text = serde_json::to_string(&page).expect("text").replace('<', "\\u003c");
    let place = folder.path("phone.html");
    fs::write(&place, PHONE.replace("PAGE", &text)).expect("a file");
    for (scheme, colours) in [("0", "dark"), ("1", "light")] {
        let (title, said) = tried(&place, &[&format!("--blink-settings=preferredColorScheme={scheme}")]);
        assert_eq!(title, format!("fits, {colours}"));
        assert_eq!(said, Vec::<String>::new());
    }
}
