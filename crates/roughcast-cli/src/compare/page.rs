//! The report as a page: numbers first, then every picture next to its ground truth and its errors.

use roughcast::shading::{FootprintModel, Shading};
use roughcast_scene::{Filter, Light, View};

use super::Compared;
use super::colour_scale::legend;
use super::measure::{Comparison, Settings, Trial};
use super::results::Row;
use super::subject::Subject;
use crate::html::Page;

/// The conventional method and the new one, which readers look for first.
pub const PAIR: [Shading; 2] = [Shading::BlinnPhong, Shading::Lean];

/// Frames per second of the animations.
const FRAMES_PER_SECOND: u16 = 8;

/// The whole report; the first map is the one given.
pub fn page(settings: &Settings<'_>, compared: &[Compared]) -> String {
    let (given, others) = compared.split_first().expect("a map was given");
    let mut page = Page::new(&format!("roughcast compare: {}", given.subject.name));
    page.paragraph(
        "Every shading model, with every texture filter, against the ground truth: many rays per pixel, each \
         shaded at the finest level, in the same form and with the same energy. All numbers are measured in linear radiance, \
         before any tone curve.",
    );
    how_it_was_made(&mut page, settings, given);
    overview(&mut page, settings, compared);
    limits(&mut page, settings, compared);
    page.heading(2, &given.subject.name);
    for comparison in &given.comparisons {
        page.heading(3, &view_heading(&given.subject, comparison));
        film(&mut page, settings, comparison);
        table(&mut page, comparison);
        pictures(&mut page, comparison, &settings.filters);
    }
    for Compared { subject, comparisons, .. } in others {
        page.heading(2, &subject.name);
        page.paragraph(&format!("{}.", subject.about));
        for comparison in comparisons {
            page.heading(3, &view_heading(subject, comparison));
            table(&mut page, comparison);
            pictures(&mut page, comparison, &[settings.main_filter()]);
        }
    }
    page.finish()
}

fn how_it_was_made(page: &mut Page, settings: &Settings<'_>, given: &Compared) {
    let (shading, size) = (settings.shading, settings.size);
    let flicker = match settings.frames {
        0 => "not measured".to_owned(),
        frames => format!("over {frames} frames of a slow camera move"),
    };
    let numbers =
        |[r, g, b]: [f32; 3]| if r == g && g == b { format!("{r}") } else { format!("{r}, {g}, {b}") };
    let mut rows = vec![
        ("map", format!("{}: {}", given.subject.name, given.subject.about)),
        ("scene", settings.scene.scene.name()),
        ("textures of the methods", format!("{} bits", shading.bits.name())),
        ("specular power s", format!("{}", shading.specular_power)),
        ("form of the lobes", shading.form.name().to_owned()),
        ("masking", shading.masking.name().to_owned()),
        ("footprint", shading.footprint.name().to_owned()),
        ("base lobe in the surface", shading.base_frame.name().to_owned()),
        (
            "ground truth",
            format!("{} samples per pixel, Gaussian pixel filter, float slopes", settings.samples),
        ),
        ("its surface between texels", settings.reconstruction.name().to_owned()),
        ("pictures", format!("{}x{} pixels", size.width, size.height)),
        ("flicker", flicker),
        (
            "material",
            format!(
                "albedo {}, ambient {}, specular {}",
                numbers(settings.albedo),
                numbers(shading.ambient),
                numbers(shading.specular)
            ),
        ),
    ];
    if settings.scene.scene.mesh_path().is_some() {
        rows.push(("normals of the mesh", settings.scene.normals.name().to_owned()));
    }
    if settings.scene.lights.is_empty() {
        let each = given.comparisons.iter().map(|c| format!("{}: {}", c.view, lights(&c.lights)));
        rows.push(("light, placed for the view", each.collect::<Vec<_>>().join("; ")));
    } else {
        rows.push(("light", lights(&settings.scene.lights)));
    }
    page.list(&rows);
    page.paragraph(
        "RMSE is the root mean square error in radiance. FLIP is the mean of HDR-FLIP, 0 to 1: the difference that a viewer \
         sees who flips between two pictures. Energy is the relative error of the highlight's light. Flicker is the variance \
         over time in excess of the ground truth's, in radiance squared. Only pixels that the surface covers fully count. The pictures of a \
         view share one exposure; they are JPEG, and the numbers are not computed from them.",
    );
    page.begin_row();
    page.picture(&legend(256, 12), "FLIP in the error pictures, from 0 to 1");
    page.end_row();
}

fn lights(lights: &[Light]) -> String {
    let one = |light: &Light| match light {
        Light::Directional { towards: at, .. } => format!("towards {:.2}, {:.2}, {:.2}", at.x, at.y, at.z),
        Light::Point { position: at, .. } => format!("a point at {:.2}, {:.2}, {:.2}", at.x, at.y, at.z),
    };
    lights.iter().map(one).collect::<Vec<_>>().join(" and ")
}

/// Conventional bump mapping against LEAN, and the best method, for every map and view.
fn overview(page: &mut Page, settings: &Settings<'_>, compared: &[Compared]) {
    page.heading(2, "Conventional bump mapping against LEAN");
    let filter = settings.main_filter();
    let mut rows = Vec::new();
    for Compared { subject, comparisons, .. } in compared {
        for comparison in comparisons {
            let [ordinary, lean] = PAIR.map(|method| comparison.trial(method, filter));
            let best = sorted(&comparison.trials)[0];
            rows.push(vec![
                format!("{}, {}", subject.name, comparison.view),
                format!("{:.4}", ordinary.row.rmse),
                format!("{:.4}", lean.row.rmse),
                format!("{:.2}", lean.row.rmse / ordinary.row.rmse),
                format!("{:.3}", ordinary.row.flip),
                format!("{:.3}", lean.row.flip),
                flicker(&ordinary.row),
                flicker(&lean.row),
                format!("{}, {}", best.row.method, best.row.filter),
            ]);
        }
    }
    page.paragraph(&format!("Both with {filter} filtering; LEAN / conventional below 1 is better."));
    page.table(
        &[
            "map, view",
            "RMSE, conventional",
            "RMSE, LEAN",
            "LEAN / conventional",
            "FLIP, conventional",
            "FLIP, LEAN",
            "flicker, conventional",
            "flicker, LEAN",
            "lowest RMSE",
        ],
        &rows,
    );
}

/// Sorted by error, smallest first.
fn sorted(trials: &[Trial]) -> Vec<&Trial> {
    let mut sorted: Vec<&Trial> = trials.iter().collect();
    sorted.sort_by(|a, b| a.row.rmse.total_cmp(&b.row.rmse));
    sorted
}

fn view_heading(subject: &Subject, comparison: &Comparison) -> String {
    format!("{}, {} view: {}", subject.name, comparison.view, span(comparison.view))
}

/// The animations: ground truth, the conventional method and the new one.
fn film(page: &mut Page, settings: &Settings<'_>, comparison: &Comparison) {
    if comparison.animation.is_empty() {
        return;
    }
    page.begin_row();
    let filter = settings.main_filter();
    let [ordinary, lean] = PAIR.map(|method| flicker(&comparison.trial(method, filter).row));
    let caption = format!(
        "While the camera moves: ground truth (off-centre Beckmann); conventional bump mapping (blinn-phong, {filter}), flicker \
         {ordinary}; LEAN ({filter}), flicker {lean}"
    );
    page.film(&comparison.animation, FRAMES_PER_SECOND, &caption);
    page.end_row();
}

fn span(view: View) -> String {
    let across = format!("{} texels per pixel", view.texels_per_pixel());
    if view == View::Grazing { format!("{across} across, many more along") } else { across }
}

fn table(page: &mut Page, comparison: &Comparison) {
    let row = |trial: &&Trial| {
        let numbers = &trial.row;
        vec![
            format!("{}, {}", numbers.method, numbers.filter),
            numbers.method.reference().name().to_owned(),
            format!("{:.5}", numbers.rmse),
            format!("{:.4}", numbers.flip),
            format!("{:+.1} %", 100.0 * numbers.energy),
            flicker(numbers),
        ]
    };
    let rows: Vec<_> = sorted(&comparison.trials).iter().map(row).collect();
    page.table(&["method, filter", "ground truth", "RMSE", "FLIP", "energy", "flicker"], &rows);
}

/// Every ground truth, and next to it each of its models' pictures with these filters and their errors.
fn pictures(page: &mut Page, comparison: &Comparison, filters: &[Filter]) {
    for (reference, truth) in &comparison.truths {
        page.begin_row();
        page.photograph(truth, &format!("{reference}: ground truth"));
        for method in Shading::ALL.iter().filter(|method| method.reference() == *reference) {
            for filter in filters {
                let trial = comparison.trial(*method, *filter);
                page.photograph(&trial.picture, &format!("{method}, {filter}: RMSE {:.4}", trial.row.rmse));
                page.picture(&trial.error, &format!("its errors: FLIP {:.3}", trial.row.flip));
            }
        }
        page.end_row();
    }
}

fn flicker(row: &Row) -> String {
    match row.flicker {
        None => "-".to_owned(),
        Some(0.0) => "0".to_owned(),
        Some(flicker) => format!("{flicker:.2e}"),
    }
}

/// What LEAN cannot represent, with the numbers.
fn limits(page: &mut Page, settings: &Settings<'_>, compared: &[Compared]) {
    page.heading(2, "What LEAN cannot do");
    page.paragraph(
        "LEAN knows the mean and the covariance of the slopes under a pixel: one Gaussian, with one direction. Where slopes come \
         in separate groups, as in sharp V grooves (two) or along the threads of a woven cloth (two directions that cross), the \
         true highlight has as many parts or is asymmetric, while LEAN has one round or oval part that covers them all, brightest where \
         the ground truth may be dark. Neither more bits nor a better filter fix that.",
    );
    page.paragraph(&format!(
        "The highlight of a whole map in one pixel that covers it, over h.xy / h.z, base roughness included (s = \
         {}). The misplaced light is the part that LEAN shows where the ground truth shows less.",
        settings.shading.specular_power
    ));
    page.begin_row();
    for Compared { subject, distribution, .. } in compared {
        let [truth, lean] = distribution.pictures();
        let (name, reach) = (&subject.name, distribution.reach);
        page.picture(&truth, &format!("{name}: ground truth, slopes from -{reach:.2} to {reach:.2}"));
        page.picture(&lean, &format!("{name}: LEAN, {} misplaced", percent(distribution.misplaced)));
    }
    page.end_row();
    let rows: Vec<_> = compared.iter().flat_map(|map| limit_rows(map, settings)).collect();
    page.paragraph(&format!("LEAN with {} filtering in the views:", settings.main_filter()));
    page.table(
        &["map, view", "misplaced, whole map", "RMSE / brightest of the ground truth", "energy"],
        &rows,
    );
    if settings.shading.footprint == FootprintModel::Published {
        page.paragraph(
            "All variance under the texture filter counts as roughness, as in the papers. Where texels are magnified, as in the near \
             view, LEAN is then duller than the ground truth: between two texels it finds the slopes of both, while the ground truth is a \
             surface that bends from one to the other.",
        );
    }
}

fn limit_rows(map: &Compared, settings: &Settings<'_>) -> Vec<Vec<String>> {
    let row = |comparison: &Comparison| {
        let lean = comparison.trial(Shading::Lean, settings.main_filter());
        vec![
            format!("{}, {}", map.subject.name, comparison.view),
            percent(map.distribution.misplaced),
            percent(lean.error_of_peak),
            format!("{:+.1} %", 100.0 * lean.row.energy),
        ]
    };
    map.comparisons.iter().map(row).collect()
}

fn percent(part: f64) -> String {
    format!("{:.1} %", 100.0 * part)
}
