//! The report as a page: numbers first, then every picture beside its truth and its errors.

use roughcast::Named;
use roughcast::shading::Shading;
use roughcast_scene::{Light, View};

use super::colour_scale::legend;
use super::measure::{Comparison, Settings, Trial};
use super::subject::Subject;
use crate::html::Page;

/// The old way and the new: what a reader looks for first.
pub const PAIR: [Shading; 2] = [Shading::BlinnPhong, Shading::Lean];

/// Frames a second of the animations.
const FRAMES_PER_SECOND: u16 = 8;

/// The whole report.
pub fn page(settings: &Settings<'_>, subjects: &[Subject], comparisons: &[Vec<Comparison>]) -> String {
    let given = &subjects[0];
    let mut page = Page::new(&format!("roughcast compare: {}", given.name));
    page.paragraph(
        "Every shading model, with every texture filter, against the truth of its own base lobe: many rays a pixel, each \
         shaded at the finest level, in the same form and with the same energy. All numbers are taken on linear radiance, \
         before any tone curve.",
    );
    how_it_was_made(&mut page, settings, subjects, &comparisons[0]);
    overview(&mut page, settings, subjects, comparisons);
    page.heading(2, &given.name);
    for comparison in &comparisons[0] {
        view(&mut page, settings, given, comparison);
    }
    limits(&mut page, settings, subjects, comparisons);
    for (subject, comparisons) in subjects.iter().zip(comparisons).skip(1) {
        page.heading(2, &subject.name);
        page.paragraph(&format!("{}.", subject.about));
        for comparison in comparisons {
            view(&mut page, settings, subject, comparison);
        }
    }
    page.finish()
}

fn how_it_was_made(page: &mut Page, settings: &Settings<'_>, subjects: &[Subject], of_given: &[Comparison]) {
    let (shading, size) = (settings.shading, settings.size);
    let flicker = match settings.frames {
        0 => "not measured".to_owned(),
        frames => format!("over {frames} frames of a slow camera move"),
    };
    let numbers =
        |[r, g, b]: [f32; 3]| if r == g && g == b { format!("{r}") } else { format!("{r}, {g}, {b}") };
    let mut rows = vec![
        ("map", format!("{}: {}", subjects[0].name, subjects[0].about)),
        ("scene", settings.scene.scene.name()),
        ("textures of the methods", format!("{} bits", shading.bits.name())),
        ("specular power s", format!("{}", shading.specular_power)),
        ("form of the lobes", shading.form.name().to_owned()),
        ("base lobe in the surface", shading.base.name().to_owned()),
        ("truth", format!("{} samples a pixel, Gaussian pixel filter, float slopes", settings.samples)),
        ("pictures", format!("{}x{} pixels", size.width, size.height)),
        ("flicker", flicker),
        (
            "material",
            format!(
                "albedo {}, ambient {}, specular {}",
                numbers(shading.albedo),
                numbers(shading.ambient),
                numbers(shading.specular)
            ),
        ),
    ];
    if settings.scene.lights.is_empty() {
        let each = of_given.iter().map(|c| format!("{}: {}", c.view, lights(&c.lights)));
        rows.push(("light, placed for the view", each.collect::<Vec<_>>().join("; ")));
    } else {
        rows.push(("light", lights(&settings.scene.lights)));
    }
    let rows: Vec<_> = rows.into_iter().map(|(name, value)| vec![name.to_owned(), value]).collect();
    page.table(&["setting", "value"], &rows);
    page.paragraph(
        "RMSE is the root mean square error in radiance. FLIP is the mean of HDR-FLIP, 0 to 1: the difference that a viewer \
         sees who flips between two pictures. Energy is the relative error of the highlight's light. Flicker is the variance \
         over time in excess of the truth's, in radiance squared. Misplaced is the part of the highlight's light that lies where \
         the truth has less of it, whatever its brightness: its shape alone. Pixels count that the surface covers fully.",
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

/// Ordinary bump mapping against LEAN, and who was best, for every map and view.
fn overview(page: &mut Page, settings: &Settings<'_>, subjects: &[Subject], comparisons: &[Vec<Comparison>]) {
    page.heading(2, "Ordinary bump mapping against LEAN");
    let filter = settings.main_filter();
    let mut rows = Vec::new();
    for (subject, comparisons) in subjects.iter().zip(comparisons) {
        for comparison in comparisons {
            let [ordinary, lean] = PAIR.map(|method| comparison.trial(method, filter));
            let best = sorted(&comparison.trials)[0];
            let flicker = |trial: &Trial| trial.row.flicker.map_or("-".to_owned(), |f| format!("{f:.2e}"));
            rows.push(vec![
                format!("{}, {}", subject.name, comparison.view),
                format!("{:.4}", ordinary.row.rmse),
                format!("{:.4}", lean.row.rmse),
                format!("{:.2}", lean.row.rmse / ordinary.row.rmse),
                format!("{:.3}", ordinary.row.flip),
                format!("{:.3}", lean.row.flip),
                flicker(ordinary),
                flicker(lean),
                format!("{}, {}", best.row.method, best.row.filter),
            ]);
        }
    }
    page.paragraph(&format!("Both with {filter} filtering; LEAN / ordinary below 1 is better."));
    page.table(
        &[
            "map, view",
            "RMSE, ordinary",
            "RMSE, LEAN",
            "LEAN / ordinary",
            "FLIP, ordinary",
            "FLIP, LEAN",
            "flicker, ordinary",
            "flicker, LEAN",
            "least RMSE of all",
        ],
        &rows,
    );
}

/// By error, the least first.
fn sorted(trials: &[Trial]) -> Vec<&Trial> {
    let mut sorted: Vec<&Trial> = trials.iter().collect();
    sorted.sort_by(|a, b| a.row.rmse.total_cmp(&b.row.rmse));
    sorted
}

/// One view of one map: moving pictures, the table, all pictures.
fn view(page: &mut Page, settings: &Settings<'_>, subject: &Subject, comparison: &Comparison) {
    let view = comparison.view;
    page.heading(3, &format!("{}, {view} view: {}", subject.name, span(view)));
    if !comparison.animation.is_empty() {
        page.begin_row();
        let [ordinary, lean] = PAIR.map(|method| {
            let trial = comparison.trial(method, settings.main_filter());
            trial.row.flicker.map_or(String::new(), |flicker| format!("flicker {flicker:.2e}"))
        });
        let caption = format!(
            "While the camera moves: truth (off-centre Beckmann); ordinary bump mapping (blinn-phong, {filter}), {ordinary}; \
             LEAN ({filter}), {lean}",
            filter = settings.main_filter()
        );
        page.animation(&comparison.animation, FRAMES_PER_SECOND, &caption);
        page.end_row();
    }
    table(page, comparison);
    for method in Shading::all() {
        pictures(page, settings, comparison, *method);
    }
}

fn span(view: View) -> String {
    let across = format!("{} texels a pixel", view.texels_per_pixel());
    if view == View::Grazing { format!("{across} across, many more along") } else { across }
}

fn table(page: &mut Page, comparison: &Comparison) {
    let row = |trial: &&Trial| {
        let numbers = &trial.row;
        vec![
            format!("{}, {}", numbers.method, numbers.filter),
            numbers.method.base_lobe().name().to_owned(),
            format!("{:.5}", numbers.rmse),
            format!("{:.4}", numbers.flip),
            format!("{:+.1} %", 100.0 * numbers.energy),
            numbers.flicker.map_or("-".to_owned(), |flicker| format!("{flicker:.2e}")),
            format!("{:.1} %", 100.0 * trial.misplaced),
        ]
    };
    let rows: Vec<_> = sorted(&comparison.trials).iter().map(row).collect();
    page.table(&["method, filter", "truth", "RMSE", "FLIP", "energy", "flicker", "misplaced"], &rows);
}

/// The truth of a model, and for every filter the model's picture and its errors.
fn pictures(page: &mut Page, settings: &Settings<'_>, comparison: &Comparison, method: Shading) {
    page.begin_row();
    let truth = format!("{method}: truth ({})", method.base_lobe());
    page.picture(comparison.truth(method), &truth);
    for filter in &settings.filters {
        let trial = comparison.trial(method, *filter);
        page.picture(&trial.picture, &format!("{method}, {filter}: RMSE {:.4}", trial.row.rmse));
        page.picture(&trial.error, &format!("its errors: FLIP {:.3}", trial.row.flip));
    }
    page.end_row();
}

/// What LEAN cannot do, with the numbers.
fn limits(page: &mut Page, settings: &Settings<'_>, subjects: &[Subject], comparisons: &[Vec<Comparison>]) {
    page.heading(2, "What LEAN cannot do");
    page.paragraph(
        "LEAN knows mean and covariance of the slopes under a pixel: one Gaussian, with one direction. Where slopes come in \
         separate groups, as in sharp V grooves (two) or along the threads of a woven cloth (two directions that cross), the true \
         highlight has as many parts, and LEAN smears one over all of them: also where the truth is dark. Its energy is right, \
         its shape is not, and neither more bits nor a better filter mend that.",
    );
    let filter = settings.main_filter();
    let mut rows = Vec::new();
    for (subject, comparisons) in subjects.iter().zip(comparisons) {
        for comparison in comparisons {
            let lean = comparison.trial(Shading::Lean, filter);
            rows.push(vec![
                format!("{}, {}", subject.name, comparison.view),
                format!("{:.1} %", 100.0 * lean.misplaced),
                format!("{:.1} %", 100.0 * lean.error_of_peak),
                format!("{:+.1} %", 100.0 * lean.row.energy),
            ]);
        }
    }
    page.paragraph(&format!("LEAN with {filter} filtering against its truth:"));
    page.table(&["map, view", "misplaced light", "RMSE / truth's brightest", "energy"], &rows);
}
