//! Picture files of each format: read to the last value, and refused where they are broken.

use std::path::Path;

use glumbra::device::Pixels;
use glumbra::output::{Output, write_all, write_described};
use glumbra::pictures::{read, read_bytes};

const SIZE: [u32; 2] = [7, 5];

/// Values that 8 bits hold, and that floats hold.
fn colors() -> Vec<u8> {
    (0..SIZE[0] * SIZE[1] * 4).map(|index| (index * 73 % 256) as u8).collect()
}

fn rgb_of(codes: &[u8]) -> Vec<f32> {
    codes.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).map(|code| f32::from(code) / 255.0).collect()
}

/// A file that glumbra writes.
fn written(name: &str, pixels: &Pixels) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    write_all(&[Output { path: &path, pixels, view: None }]).unwrap();
    std::fs::read(&path).unwrap()
}

fn encoded(image: impl Into<image::DynamicImage>) -> Vec<u8> {
    let mut file = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut file, image::ImageFormat::Png).unwrap();
    file.into_inner()
}

#[test]
fn what_glumbra_writes_is_read() {
    let codes = colors();
    let eight = Pixels::Rgba8 { size: SIZE, data: codes.clone() };
    let float: Vec<f32> = (0..SIZE[0] * SIZE[1] * 4).map(|index| index as f32 * 0.37 - 3.0).collect();
    let rgb: Vec<f32> = float.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let floats = Pixels::RgbaF32 { size: SIZE, data: float };
    let depth = Pixels::Depth { size: SIZE, data: (0..35).map(|index| index as f32 / 35.0).collect() };
    for (name, pixels, channels, expected) in [
        ("a.png", &eight, 3, rgb_of(&codes)),
        ("a.exr", &eight, 3, rgb_of(&codes)),
        ("a.npy", &eight, 3, rgb_of(&codes)),
        ("a.exr", &floats, 3, rgb.clone()),
        ("a.npy", &floats, 3, rgb),
        ("a.exr", &depth, 1, (0..35).map(|index| index as f32 / 35.0).collect()),
        ("a.npy", &depth, 1, (0..35).map(|index| index as f32 / 35.0).collect()),
    ] {
        let raster = read_bytes(&written(name, pixels)).unwrap().raster;
        assert_eq!((raster.size, raster.channels), (SIZE, channels), "{name}");
        assert_eq!(raster.data, expected, "{name}");
    }
}

#[test]
fn each_kind_of_png_is_read() {
    let [width, height] = SIZE;
    let value = |x: u32, y: u32, k: u32| (40 * x + 7 * y + 60 * k) as u8;
    let wide = |x: u32, y: u32| (4001 * x + 977 * y) as u16;
    let gray = encoded(image::GrayImage::from_fn(width, height, |x, y| image::Luma([value(x, y, 0)])));
    let shade = image::GrayAlphaImage::from_fn(width, height, |x, y| image::LumaA([value(x, y, 0), value(x, y, 1)]));
    let rgba = image::RgbaImage::from_fn(width, height, |x, y| image::Rgba([0, 1, 2, 3].map(|k| value(x, y, k))));
    let deep = image::ImageBuffer::from_fn(width, height, |x, y| image::Luma([wide(x, y)]));
    for (bytes, channels) in [(gray, 1), (encoded(shade), 2), (encoded(rgba), 4)] {
        let raster = read_bytes(&bytes).unwrap().raster;
        assert_eq!(raster.channels, channels);
        for (x, y) in [(0, 0), (6, 0), (3, 4)] {
            let expected: Vec<f32> = (0..channels as u32).map(|k| f32::from(value(x, y, k)) / 255.0).collect();
            assert_eq!(raster.pixel([x, y]), expected, "{channels} channels at ({x}, {y})");
        }
    }
    let raster = read_bytes(&encoded(deep)).unwrap().raster;
    assert_eq!(raster.pixel([5, 3]), [f32::from(wide(5, 3)) / 65535.0]);
}

/// NPY files as NumPy writes them.
fn npy(descr: &str, order: &str, shape: &str, content: &[u8]) -> Vec<u8> {
    let header = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': ({shape}), }}\n");
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(content);
    bytes
}

#[test]
fn each_kind_of_npy_is_read() {
    let values = [0.0_f64, 0.25, 1.0, -2.0, 0.5, 8.0];
    let of = |bytes: Vec<Vec<u8>>| bytes.concat();
    let f4 = of(values.iter().map(|v| (*v as f32).to_le_bytes().to_vec()).collect());
    let f8 = of(values.iter().map(|v| v.to_le_bytes().to_vec()).collect());
    let big = of(values.iter().map(|v| v.to_be_bytes().to_vec()).collect());
    for (descr, content) in [("<f4", &f4), ("<f8", &f8), (">f8", &big)] {
        let raster = read_bytes(&npy(descr, "False", "2, 3", content)).unwrap().raster;
        assert_eq!((raster.size, raster.channels), ([3, 2], 1), "rows come first");
        assert_eq!(raster.data, values.map(|value| value as f32), "{descr}");
        let raster = read_bytes(&npy(descr, "False", "1, 2, 3", content)).unwrap().raster;
        assert_eq!((raster.size, raster.channels), ([2, 1], 3));
    }
    let codes = read_bytes(&npy("|u1", "False", "1, 3", &[0, 51, 255])).unwrap().raster;
    assert_eq!(codes.data, [0.0, 0.2, 1.0]);
    let codes = read_bytes(&npy("<u2", "False", "1, 2", &[0xff, 0xff, 0, 0])).unwrap().raster;
    assert_eq!(codes.data, [1.0, 0.0]);
    for (file, error) in [
        (npy("<f4", "True", "2, 3", &f4), "Fortran"),
        (npy("<c8", "False", "2, 3", &f8), "<c8 is not read"),
        (npy("<f4", "False", "6,", &f4), "is not that of a picture"),
        (npy("<f4", "False", "2, 4", &f4), "is it cut off?"),
        (npy("<f4", "False", "2, 2", &f4), "bytes follow the header"),
        (npy("<f4", "False", "0, 3", &[]), "no picture's size"),
        (npy("<f4", "False", "99999999999999999999, 3", &f4), "is not that of a picture"),
        (npy("<f4", "False", "4294967296, 4294967296", &f4), "no picture's size"),
        (npy("<f4", "False", "100000, 100000", &f4), "more than can be compared"),
        (b"\x93NUMPY\x09\x00".to_vec(), "version 9"),
    ] {
        let said = read_bytes(&file).unwrap_err();
        assert!(said.contains(error), "{error}: {said}");
    }
}

/// One of each format.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let eight = Pixels::Rgba8 { size: SIZE, data: colors() };
    let floats = Pixels::RgbaF32 { size: SIZE, data: (0..140).map(|index| index as f32).collect() };
    let f8 = npy("<f8", "False", "5, 7", &[0; 8 * 35]);
    vec![
        ("png", written("a.png", &eight)),
        ("exr", written("a.exr", &floats)),
        ("npy", written("a.npy", &floats)),
        ("npy f8", f8),
    ]
}

#[test]
fn a_file_that_is_cut_off_anywhere_is_refused() {
    for (name, bytes) in files() {
        read_bytes(&bytes).unwrap();
        for length in 0..bytes.len() {
            // Of a PNG the last chunk says only that it ends.
            let ends = name == "png" && length + 12 >= bytes.len();
            assert!(ends || read_bytes(&bytes[..length]).is_err(), "{name} cut to {length} of {}", bytes.len());
        }
    }
}

/// Any byte may be any other. A file may be read or refused, and nothing else.
#[test]
fn files_with_wrong_bytes_do_not_panic() {
    let mut random = fastrand::Rng::with_seed(20_261_128);
    for (_, bytes) in files() {
        for index in 0..bytes.len().min(600) {
            for value in [0, 0xff, bytes[index] ^ 1, random.u8(..)] {
                let mut broken = bytes.clone();
                broken[index] = value;
                let _ = read_bytes(&broken);
            }
        }
        for _ in 0..300 {
            let mut broken = bytes.clone();
            for _ in 0..random.usize(1..9) {
                let index = random.usize(..broken.len());
                broken[index] = random.u8(..);
            }
            let _ = read_bytes(&broken);
        }
    }
    assert!(read_bytes(b"GIF89a").unwrap_err().contains("no PNG, EXR or NPY"));
    assert!(read_bytes(&[]).is_err());
}

/// Headers that promise terabytes.
#[test]
fn sizes_that_a_file_cannot_hold_reserve_nothing() {
    let mut png = files().remove(0).1;
    png[16..24].copy_from_slice(&[0, 0, 0x40, 0, 0, 0, 0x20, 0]);
    let crc = crc32(&png[12..29]);
    png[29..33].copy_from_slice(&crc.to_be_bytes());
    let said = read_bytes(&png).unwrap_err();
    assert!(said.contains("is cut off") || said.contains("more than can be compared"), "{said}");
    let exr = files().remove(1).1;
    // The windows: four numbers each, of which the third and fourth are the greatest column and row.
    let window = |name: &[u8]| exr.windows(name.len()).position(|part| part == name).unwrap() + name.len();
    let mut broken = exr.clone();
    for start in [window(b"dataWindow\0box2i\0"), window(b"displayWindow\0box2i\0")] {
        for place in [start + 12, start + 16] {
            broken[place..place + 4].copy_from_slice(&30_000_i32.to_le_bytes());
        }
    }
    let said = read_bytes(&broken).unwrap_err();
    assert!(said.contains("more than can be compared") || said.contains("cut off"), "{said}");
}

/// The checksum of a PNG's chunk.
fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(u32::MAX, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), |crc, _| step(crc)))
}

#[test]
fn texts_of_a_png_come_back_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let pixels = Pixels::Rgba8 { size: SIZE, data: colors() };
    let outputs = [Output { path: &path, pixels: &pixels, view: None }];
    let texts =
        [("Scene", String::from("a b.toml")), ("Driver", String::from("llvmpipe")), ("Lüge", String::from("é"))];
    write_described(&outputs, &texts[..2]).unwrap();
    let file = read(&path).unwrap();
    let software = ("Software", concat!("glumbra ", env!("CARGO_PKG_VERSION")).to_owned());
    let expected: Vec<(String, String)> =
        [&software].into_iter().chain(&texts[..2]).map(|(key, text)| ((*key).to_owned(), text.clone())).collect();
    assert_eq!(file.texts, expected);
    assert_eq!(file.raster.data, rgb_of(&colors()), "texts change no pixel");
    write_described(&outputs, &texts[2..]).unwrap();
    assert_eq!(read(&path).unwrap().texts[1].1, "é");
    // A program of its own name.
    write_described(&outputs, &[("Software", String::from("other"))]).unwrap();
    assert_eq!(read(&path).unwrap().texts, [("Software".to_owned(), "other".to_owned())]);
    assert!(read(Path::new("/nowhere.png")).unwrap_err().to_string().starts_with("/nowhere.png: "));
}
