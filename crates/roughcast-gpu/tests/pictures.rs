//! Pictures of the same scenes by the CPU and by the GPU.

mod common;

use common::gpu;
use common::pictures::{Apart, GpuPictures, apart, by_cpu, inside, options, within_texel};
use common::scenes::{SIZE, SPECULAR_POWER, maps, scenes};
use roughcast::Bits;
use roughcast::shading::{BaseLobe, Form, LobeOptions, Shading};
use roughcast_scene::{Filter, Sampler};

#[test]
fn explore() {
    let gpu = gpu();
    for (name, scene) in scenes() {
        let mut pictures = GpuPictures::new(&gpu, &scene, 256);
        for shading in Shading::ALL {
            let maps = maps(*shading, Bits::Half);
            for (form, base) in [(Form::Paper, BaseLobe::Plane), (Form::Normalised, BaseLobe::Facet)] {
                let lobe =
                    LobeOptions { specular_power: SPECULAR_POWER, form, base, ..LobeOptions::default() };
                for (filter, level) in [
                    (Filter::Nearest, Some(0.0)),
                    (Filter::Trilinear, None),
                    (Filter::Trilinear, Some(1.5)),
                    (Filter::Anisotropic, None),
                ] {
                    let sampler = Sampler { filter, level, ..Sampler::default() };
                    let draw = options(sampler, lobe);
                    let cpu = by_cpu(&scene, *shading, &maps, &draw, SIZE);
                    let gpu = pictures.render(&scene, *shading, &maps, &draw, SIZE).unwrap();
                    let all = apart(&cpu, &gpu, |i| {
                        inside(&cpu, &gpu, i)
                            && (filter != Filter::Nearest || within_texel(&scene, SIZE, i, 64.0, 0.02))
                    });
                    println!("{name} {shading} {form} {filter} {level:?}: {all:?}");
                }
            }
        }
    }
}
