//! Scenes that are broken on purpose before they are drawn, each by one mistake of bump mapping: the colours in f64 of the
//! right scene see it.

use std::sync::Arc;

use glumbra::geometry::{Bump, Material, Mesh};
use glumbra::scene::Scene;

use super::{colors, data, load_text, picture, renderer, tally};

/// A torus near by and one far away; a mirrored square.
fn scene(method: &str) -> Scene {
    let heights = data("textures/studs.png");
    let gloss = data("textures/knight-gloss.png");
    let mesh = "v -1 0 -1\nv 0 0 -1\nv 1 0 -1\nv -1 0 1\nv 0 0 1\nv 1 0 1\nvt 1 1\nvt 0 1\nvt 1 1\nvt 1 0\nvt 0 0\nvt 1 0\n\
                vn 0 1 0\nf 4/4/1 5/5/1 2/2/1 1/1/1\nf 5/5/1 6/6/1 3/3/1 2/2/1\n";
    let material = format!(
        "material = {{ diffuse = [0.9, 0.8, 0.7], specular = [0.5, 0.5, 0.5], shininess = 8, gloss = {gloss:?}, \
         bump = {{ height = {heights:?}, scale = 6.0 }} }}"
    );
    let text = format!(
        "[image]\nsize = [200, 150]\n[camera]\neye = [0.0, 2.2, 2.4]\ntarget = [0.0, 0.1, -0.4]\nfov_y = 55.0\n[shading]\n\
         ambient = [0.1, 0.1, 0.1]\nbump = \"{method}\"\n\
         [[light]]\nkind = \"point\"\nposition = [1.8, 1.0, -1.2]\nnear = 0.1\nfar = 20.0\ndiffuse = [0.8, 0.8, 0.7]\nspecular = [0.6, 0.6, 0.6]\n\
         [light.shadow]\ntechnique = \"none\"\n\
         [[object]]\nmesh = \"torus\"\nscale = 0.7\ntranslate = [-0.9, 0.5, 0.0]\nrotate = {{ axis = [1.0, 0.0, 0.4], angle = 30.0 }}\n{material}\n\
         [[object]]\nmesh = \"torus\"\ntranslate = [4.0, 1.5, -12.0]\nrotate = {{ axis = [1.0, 0.0, 0.0], angle = 60.0 }}\n{material}\n\
         [[object]]\nmesh = \"mirrored.obj\"\ntranslate = [1.0, 0.0, 0.0]\n{material}\n"
    );
    load_text(&text, &[("mirrored.obj", mesh.as_bytes().to_vec())]).unwrap()
}

fn each_mesh(scene: &mut Scene, change: impl Fn(&mut Mesh)) {
    for object in &mut scene.objects {
        change(Arc::make_mut(&mut object.mesh));
    }
}

fn each_material(scene: &mut Scene, change: impl Fn(&mut Material)) {
    for object in &mut scene.objects {
        if let Some(material) = &mut object.material {
            change(Arc::make_mut(material));
        }
    }
}

/// Each texel of each bump map.
fn each_texel(scene: &mut Scene, change: impl Fn(&mut [u8; 4])) {
    each_material(scene, |material| {
        let bump: &Bump = material.bump.as_ref().unwrap();
        let mut map = (*bump.map).clone();
        map.levels.iter_mut().flatten().for_each(&change);
        material.bump = Some(Arc::new(Bump { map: Arc::new(map), ..bump.clone() }));
    });
}

fn negated(all: &mut [[f32; 3]]) {
    all.iter_mut().for_each(|vector| *vector = vector.map(|part| -part));
}

type Mistake = (&'static str, fn(&mut Scene));

const MISTAKES: [Mistake; 10] = [
    ("B the other way around", |scene| {
        each_mesh(scene, |mesh| negated(&mut mesh.tangents.as_mut().unwrap().bitangents));
    }),
    ("T and B exchanged", |scene| {
        each_mesh(scene, |mesh| {
            let directions = mesh.tangents.as_mut().unwrap();
            std::mem::swap(&mut directions.tangents, &mut directions.bitangents);
        });
    }),
    ("N of a mirrored skin not turned outwards", |scene| {
        let mesh = Arc::make_mut(&mut scene.objects[2].mesh);
        for triangle in mesh.indices.clone().as_chunks::<3>().0 {
            let middle: f32 = triangle.iter().map(|index| mesh.positions[*index as usize][0]).sum();
            // The triangles on the right, each vertex once: halves share none.
            if middle < 0.0 {
                triangle.iter().for_each(|index| mesh.normals[*index as usize] = [0.0, -1.0, 0.0]);
            }
        }
    }),
    ("T of a mirrored skin turned", |scene| {
        let mesh = Arc::make_mut(&mut scene.objects[2].mesh);
        let directions = mesh.tangents.as_mut().unwrap();
        for (tangent, place) in directions.tangents.iter_mut().zip(&mesh.positions) {
            if tangent[0] < 0.0 || place[0] < 0.0 {
                *tangent = tangent.map(|part| -part);
            }
        }
    }),
    ("no self-shadowing", |scene| scene.shading.bumps.self_shadow = false),
    ("no dimming of smaller levels", |scene| each_texel(scene, |texel| texel[3] = 127)),
    ("heights turned into depths", |scene| {
        each_texel(scene, |texel| [texel[0], texel[1]] = [texel[0], texel[1]].map(|code| (-(code as i8)) as u8));
    }),
    ("x and y exchanged", |scene| each_texel(scene, |texel| texel.swap(0, 1))),
    ("no gloss", |scene| each_material(scene, |material| material.gloss = None)),
    ("no bumps", |scene| each_texel(scene, |texel| *texel = [0, 0, 127, 127])),
];

#[test]
fn every_mistake_is_seen() {
    let (_context, mut renderer) = renderer();
    for method in ["reference", "one-pass"] {
        let right = scene(method);
        assert_eq!(right.objects[2].bases.unwrap().mirrored, 2);
        let truth = colors(&right, &[None]);
        let own = tally(&right, &[&truth], &picture(&right, &mut renderer));
        assert_eq!(own.wrong, 0, "{method}: {:?}", own.first);
        for (what, mistake) in MISTAKES {
            if what == "no self-shadowing" && method != "reference" {
                continue; // their programs have the factor
            }
            let mut broken = right.clone();
            mistake(&mut broken);
            let found = tally(&right, &[&truth], &picture(&broken, &mut renderer));
            println!("{method}, {what}: {} pixels wrong, by up to {:.0} codes", found.wrong, found.worst);
            assert!(found.wrong >= 20, "{method}, {what}: {} pixels", found.wrong);
        }
    }
}
