//! Decodes many files for comparison with other decoders: `dump LIST SAMPLES`.
//!
//! LIST has one file per line: path, layer and channels (separated by commas), separated by tabs; the last two may be empty.
//! Each file gives one line on standard output, its fields separated by tabs: `read`, width, height, channels, sample type,
//! range, warnings; or `refused` and the error; or `panicked` and the message. The samples of the files that were read
//! are written to SAMPLES, one file after the other, little-endian.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::panic::catch_unwind;
use std::path::Path;
use std::process::ExitCode;

use roughcast::Samples;
use roughcast_io::{Decoded, ReadError, ReadOptions, read_image_file};

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [list, samples] = &arguments[..] else {
        eprintln!("dump: give it a list of files and a file for the samples");
        return ExitCode::FAILURE;
    };
    match run(list.as_ref(), samples.as_ref()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("dump: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(list: &Path, samples: &Path) -> std::io::Result<()> {
    // A panic's message becomes a line of the output.
    std::panic::set_hook(Box::new(|_| {}));
    let mut samples = BufWriter::new(File::create(samples)?);
    let mut answers = std::io::stdout().lock();
    for line in std::fs::read_to_string(list)?.lines() {
        let answer = match catch_unwind(|| read(line)) {
            Ok(Ok(decoded)) => {
                samples.write_all(&little_endian(decoded.image.samples()))?;
                description(&decoded)
            }
            Ok(Err(error)) => format!("refused\t{}", plain(&error.to_string())),
            Err(panic) => {
                let text = panic.downcast_ref::<String>().map(String::as_str);
                let text = text.or_else(|| panic.downcast_ref::<&str>().copied());
                format!("panicked\t{}", plain(text.unwrap_or("without a message")))
            }
        };
        writeln!(answers, "{answer}")?;
    }
    samples.flush()
}

fn read(line: &str) -> Result<Decoded, ReadError> {
    let mut fields = line.split('\t');
    let path = fields.next().unwrap_or_default();
    let layer = fields.next().filter(|layer| !layer.is_empty()).map(str::to_owned);
    let channels = fields.next().unwrap_or_default();
    let channels = channels.split(',').filter(|name| !name.is_empty()).map(str::to_owned).collect();
    read_image_file(Path::new(path), &ReadOptions::default().with_layer(layer).with_channels(channels))
}

fn description(decoded: &Decoded) -> String {
    let Decoded { image, info } = decoded;
    let sample = match image.samples() {
        Samples::U8(_) => "u8",
        Samples::U16(_) => "u16",
        Samples::F16(_) => "f16",
        Samples::F32(_) => "f32",
    };
    let names: Vec<String> = info.channels.iter().map(|name| plain(name).replace(',', ";")).collect();
    format!(
        "read\t{}\t{}\t{}\t{sample}\t{:?}\t{}",
        image.width(),
        image.height(),
        names.join(","),
        info.range,
        plain(&info.warnings.join("; ")),
    )
}

/// Replaces field and line separators in a text.
fn plain(text: &str) -> String {
    text.replace(char::is_control, " ")
}

fn little_endian(samples: &Samples) -> Vec<u8> {
    match samples {
        Samples::U8(samples) => samples.clone(),
        Samples::U16(samples) => samples.iter().flat_map(|sample| sample.to_le_bytes()).collect(),
        Samples::F16(samples) => samples.iter().flat_map(|sample| sample.to_le_bytes()).collect(),
        Samples::F32(samples) => samples.iter().flat_map(|sample| sample.to_le_bytes()).collect(),
    }
}
