//! With every fragment counted and the eye outside, a closed volume's ways in and out cancel on every pixel (rule GL-S3).

use std::sync::Arc;

use glam::{DMat4, DVec3};
use glumbra::context::{self, ContextRequest};
use glumbra::device::{Device, Measure, Pixels};
use glumbra::geometry::Mesh;
use glumbra::geometry::volume::{Caps, Caster, Extent, LightSource, Outline, Volume};
use glumbra::lights::Viewer;
use glumbra::lights::light::{StencilCount, VolumeDraw, VolumeSpace};
use glumbra::math::spaces::{infinite_perspective, view_from_world};
use glumbra::pass::{
    Chunk, Clear, DrawPass, DrawState, FixedFunctionDesc, Format, ImageDesc, ImageId, MeshRef, Pass, PassList,
    Primitive, Redraw, Stencil, StencilOp, StencilOps, Storage, Target, Work,
};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngSeed, TestRunner};

use crate::volumes::homogeneous::{Random, exits, triangles};
use crate::volumes::shapes::{soup, source};

const SIZE: [u32; 2] = [48, 48];

fn list(volume: &Volume, viewer: &Viewer) -> PassList {
    let mesh = Mesh { homogeneous: volume.vertices().to_vec(), indices: volume.indices().to_vec(), ..Mesh::default() };
    let mesh = MeshRef(Arc::new(mesh));
    let draw = |indices, reversed| VolumeDraw {
        label: String::from("volume"),
        mesh: mesh.clone(),
        primitive: Primitive::Triangles,
        indices,
        space: VolumeSpace::Model { world_from_model: DMat4::IDENTITY },
        reversed,
    };
    let draws = [
        draw(volume.sides(), false),
        draw(volume.light_cap(), false),
        draw(volume.light_cap_reversed(), true),
        draw(volume.far_cap(), false),
    ];
    let draws: Vec<VolumeDraw> = draws.into_iter().filter(|draw| !draw.indices.is_empty()).collect();
    let passes = |op| StencilOps { pass: op, ..StencilOps::KEEP };
    let stencil = Stencil {
        test: glumbra::pass::Compare::Always,
        reference: 0,
        read_mask: 0xFF,
        write_mask: 0xFF,
        front: passes(StencilOp::IncrementWrap),
        back: passes(StencilOp::DecrementWrap),
    };
    let nothing = Chunk { name: "nothing".into(), text: "void main() {}\n".into() };
    let pass = DrawPass {
        target: Target { color: None, depth: Some(ImageId(0)), level: 0, face: None },
        viewport: SIZE,
        clear: Clear { stencil: Some(0), ..Clear::default() },
        state: DrawState { depth_test: None, depth_write: false, stencil: Some(stencil), ..DrawState::DEPTH_ONLY },
        batches: StencilCount::batches(
            &draws,
            viewer,
            None,
            nothing,
            FixedFunctionDesc::Shader("a volume"),
            Vec::new(),
        ),
    };
    let label = String::from("depth and stencil");
    let image = ImageDesc { label, size: SIZE, format: Format::Depth24Stencil8, storage: Storage::Renderbuffer };
    let pass = Pass { label: String::from("count"), redraw: Redraw::Always, work: Work::Draw(pass) };
    PassList { images: vec![image], passes: vec![pass], ..PassList::default() }
}

#[test]
fn a_thousand_random_volumes_close() {
    let context = context::open(&ContextRequest::default()).unwrap();
    let mut device = Device::new(&context);
    let mut runner = TestRunner::new(Config { rng_seed: RngSeed::Fixed(1977), ..Config::default() });
    let mut random = Random::new(42);
    let (mut outline, mut volume) = (Outline::default(), Volume::default());
    let (mut held, mut drawn) = (0, 0);
    while held < 1000 {
        let caster = Caster::of_mesh(&soup().new_tree(&mut runner).unwrap().current());
        let source: LightSource = source().new_tree(&mut runner).unwrap().current();
        outline.find(&caster, source);
        volume.extrude(&caster, &outline, Extent::Infinite, Caps::BOTH);
        let eye = random.vector(4.0);
        let inside = exits(&triangles(&volume), eye, random.vector(1.0)) != 0;
        if volume.indices().is_empty() || inside {
            continue;
        }
        let viewer = Viewer {
            clip_from_eye: infinite_perspective(1.3, 1.0, 1e-3),
            eye_from_world: view_from_world(eye, random.vector(1.0), DVec3::Y),
        };
        let list = list(&volume, &viewer);
        let times = device.run(&list, Measure::Fragments).unwrap();
        drawn += times[0].fragments.unwrap_or(0);
        let Pixels::Stencil { data, .. } = device.read_stencil(&list, ImageId(0)).unwrap() else {
            panic!("no stencil")
        };
        let open = data.iter().filter(|count| **count != 0).count();
        assert_eq!(open, 0, "volume {held}, light {source:?}, eye {eye}: {open} pixels do not close");
        held += 1;
    }
    println!("1000 volumes, {drawn} fragments: every pixel closes");
    assert!(drawn > 1_000_000, "{drawn}");
}
