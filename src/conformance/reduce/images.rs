//! Effects of calls on images and framebuffers: definitions, attachments, clears, copies, read-backs.

use super::effects::{Attachment, Tracker, made, object};
use super::log::{Argument, Recorded};
use super::meaning::Kind;
use super::state::{Effects, Key, State};

/// The binding target of a texture's part: a face's is the cube map.
fn binding(target: u32) -> u32 {
    if (glow::TEXTURE_CUBE_MAP_POSITIVE_X..=glow::TEXTURE_CUBE_MAP_NEGATIVE_Z).contains(&target) {
        glow::TEXTURE_CUBE_MAP
    } else {
        target
    }
}

impl Tracker {
    pub(super) fn attach(&mut self, call: &Recorded) -> Effects {
        let which = if call.u(0) == glow::READ_FRAMEBUFFER { "ReadFramebuffer" } else { "DrawFramebuffer" };
        let framebuffer = self.framebuffer(which);
        let (image, kind, number) = match call.name {
            "glFramebufferRenderbuffer" => ("rb", Kind::Renderbuffer, object(call, 3)),
            "glFramebufferTexture2D" => ("img", Kind::Texture, object(call, 3)),
            _ => ("img", Kind::Texture, object(call, 2)),
        };
        let (part, is_flat) = match call.name {
            "glFramebufferRenderbuffer" => ("all".to_owned(), true),
            "glFramebufferTexture2D" => (format!("{:04X}:{}", call.u(2), call.u(4)), true),
            "glFramebufferTextureLayer" => (format!("layer {}:{}", call.u(4), call.u(3)), false),
            _ => (format!("all:{}", call.u(3)), false),
        };
        let attachment = Attachment { image: format!("{image}:{number}"), part, is_flat };
        let points: &[u32] = match call.u(1) {
            glow::DEPTH_STENCIL_ATTACHMENT => &[glow::DEPTH_ATTACHMENT, glow::STENCIL_ATTACHMENT],
            point => &[point],
        };
        let mut reads = vec![which.to_owned(), made(kind, number)];
        reads.extend(
            self.contents.get(&attachment.image).into_iter().flatten().filter(|key| key.contains("/def")).cloned(),
        );
        let mut sets = Vec::new();
        for point in points {
            sets.push((format!("fb:{framebuffer}:{point:04X}"), format!("{attachment:?}")));
            if number == 0 {
                self.attachments.remove(&(framebuffer, *point));
            } else {
                self.attachments.insert((framebuffer, *point), attachment.clone());
            }
        }
        Effects::set(sets, reads)
    }

    pub(super) fn texture(&mut self, call: &Recorded) -> Effects {
        let unit = self.unit();
        let target = binding(call.u(0));
        let image = format!("img:{}", self.bound(unit, target));
        let mut reads = vec!["ActiveTexture".to_owned(), format!("tex:{unit}:{target:04X}")];
        let part = format!("{image}/def:{:04X}:{}", call.u(0), call.u(1));
        let transfer = |state: &State| -> Vec<Key> {
            ["glPixelStorei:", "glPixelTransferf:"]
                .iter()
                .flat_map(|head| state.keys(head).cloned().collect::<Vec<_>>())
                .collect()
        };
        match call.name {
            "glGenerateMipmap" => {
                reads.extend(self.contents.get(&image).into_iter().flatten().cloned());
                reads.extend(self.state.keys(&format!("texpar:{}:", &image[4..])).cloned());
                Effects::change(vec![format!("{image}/def:mipmap")], reads)
            }
            "glCopyTexImage2D" | "glCopyTexSubImage2D" => {
                reads.extend(self.read_contents());
                reads.extend(transfer(&self.state));
                if call.name == "glCopyTexImage2D" {
                    self.sizes.insert(format!("{image}:{:04X}:{}", call.u(0), call.u(1)), [call.i(5), call.i(6)]);
                }
                Effects::change(vec![part], reads)
            }
            name => {
                if matches!(call.arguments.last(), Some(Argument::Data(_))) {
                    reads.extend(transfer(&self.state));
                }
                let size = if name == "glTexImage1D" { [call.i(3), 1] } else { [call.i(3), call.i(4)] };
                if name == "glTexSubImage2D" {
                    return Effects::change(vec![part], reads);
                }
                self.sizes.insert(format!("{image}:{:04X}:{}", call.u(0), call.u(1)), size);
                // What was drawn into it is no more, either; it is kept all the same.
                Effects::make(vec![part], reads)
            }
        }
    }

    /// Attachments of a bound framebuffer, their images' definitions, and the framebuffer.
    pub(super) fn attached(&self, which: &str) -> Vec<Key> {
        let framebuffer = self.framebuffer(which);
        let mut reads = vec![which.to_owned(), format!("fb:{framebuffer}:draw"), format!("fb:{framebuffer}:read")];
        for ((_, point), attachment) in self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)) {
            reads.push(format!("fb:{framebuffer}:{point:04X}"));
            let contents = self.contents.get(&attachment.image).into_iter().flatten();
            reads.extend(contents.filter(|key| key.contains("/def")).cloned());
            if let Some(number) = attachment.image.strip_prefix("img:") {
                reads.extend(["813C", "813D"].map(|name| format!("texpar:{number}:{name}")));
            }
        }
        reads
    }

    pub(super) fn aspect(point: u32) -> &'static str {
        match point {
            glow::DEPTH_ATTACHMENT => "depth",
            glow::STENCIL_ATTACHMENT => "stencil",
            _ => "color",
        }
    }

    /// Keys of what is in a framebuffer's images: of one aspect, or of all.
    pub(super) fn drawn(&self, which: &str, aspects: &[&str]) -> Vec<Key> {
        let framebuffer = self.framebuffer(which);
        let mut keys = Vec::new();
        for ((_, point), attachment) in self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)) {
            let aspect = Self::aspect(*point);
            if aspects.contains(&aspect) {
                keys.push(format!("{}/{}/{aspect}", attachment.image, attachment.part));
            }
        }
        keys
    }

    /// The same, with all that was drawn into the images in another way.
    pub(super) fn drawn_and_given(&self, which: &str, aspects: &[&str]) -> Vec<Key> {
        let framebuffer = self.framebuffer(which);
        let mut keys = self.drawn(which, aspects);
        for (_, attachment) in self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)) {
            let is_other = |key: &&Key| {
                let own = key.contains(&format!("/{}/", attachment.part)) && attachment.is_flat;
                !own && (key.contains("/layer") || key.contains("/all:") || key.contains("/def"))
            };
            keys.extend(self.contents.get(&attachment.image).into_iter().flatten().filter(is_other).cloned());
        }
        keys
    }

    pub(super) fn read_contents(&self) -> Vec<Key> {
        let mut reads = self.attached("ReadFramebuffer");
        reads.extend(self.drawn_and_given("ReadFramebuffer", &["color", "depth", "stencil"]));
        reads
    }

    pub(super) fn read_pixels(&self, call: &Recorded) -> Effects {
        let aspects: &[&str] = match call.u(4) {
            glow::DEPTH_COMPONENT => &["depth"],
            glow::STENCIL_INDEX => &["stencil"],
            glow::DEPTH_STENCIL => &["depth", "stencil"],
            _ => &["color"],
        };
        let mut reads = self.attached("ReadFramebuffer");
        reads.extend(self.drawn_and_given("ReadFramebuffer", aspects));
        for head in ["glPixelStorei:0D", "glPixelTransferf:", "glClampColor:"] {
            reads.extend(self.state.keys(head).cloned());
        }
        Effects::change(Vec::new(), reads)
    }

    /// The image's size, if the attachment is a whole level of a 2D image or a renderbuffer.
    pub(super) fn size_of(&self, attachment: &Attachment) -> Option<[i32; 2]> {
        let key = if attachment.part == "all" {
            attachment.image.clone()
        } else {
            format!("{}:{}", attachment.image, attachment.part)
        };
        attachment.is_flat.then(|| self.sizes.get(&key).copied()).flatten()
    }

    /// Tests whether clears and draws reach all of the framebuffer's images.
    pub(super) fn scissor_is_open(&self) -> bool {
        if !self.state.is_on(glow::SCISSOR_TEST) {
            return true;
        }
        let framebuffer = self.framebuffer("DrawFramebuffer");
        let scissor = self.state.numbers("glScissor");
        let mut sizes =
            self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)).map(|(_, at)| self.size_of(at));
        let [x, y, width, height] = *scissor else { return false };
        sizes.all(|size| {
            size.is_some_and(|[w, h]| x <= 0.0 && y <= 0.0 && x + width >= f64::from(w) && y + height >= f64::from(h))
        })
    }

    pub(super) fn scissor_keys(&self) -> Vec<Key> {
        let mut keys = vec![format!("cap:{:04X}", glow::SCISSOR_TEST)];
        keys.extend(self.state.is_on(glow::SCISSOR_TEST).then(|| "glScissor".to_owned()));
        keys
    }

    pub(super) fn clear(&self, call: &Recorded) -> Effects {
        let bits = match (call.name, call.u(0)) {
            ("glClear", bits) => bits,
            (_, glow::COLOR) => glow::COLOR_BUFFER_BIT,
            (_, glow::DEPTH) => glow::DEPTH_BUFFER_BIT,
            (_, glow::STENCIL) => glow::STENCIL_BUFFER_BIT,
            _ => glow::DEPTH_BUFFER_BIT | glow::STENCIL_BUFFER_BIT,
        };
        let mut reads = self.attached("DrawFramebuffer");
        reads.extend(self.scissor_keys());
        let mut aspects = Vec::new();
        let mut is_whole = self.scissor_is_open();
        let is_glclear = call.name == "glClear";
        if bits & glow::COLOR_BUFFER_BIT != 0 {
            aspects.push("color");
            reads.extend([
                "glColorMask".into(),
                format!("cap:{:04X}", glow::FRAMEBUFFER_SRGB),
                format!("cap:{:04X}", glow::DITHER),
            ]);
            reads.extend(is_glclear.then(|| "glClearColor".into()));
            is_whole &= self.state.get("glColorMask") == Some("1,1,1,1");
        }
        if bits & glow::DEPTH_BUFFER_BIT != 0 {
            aspects.push("depth");
            reads.push("glDepthMask".into());
            reads.extend(is_glclear.then(|| "ClearDepth".into()));
            is_whole &= self.state.get("glDepthMask") == Some("1");
        }
        if bits & glow::STENCIL_BUFFER_BIT != 0 {
            aspects.push("stencil");
            reads.extend(["StencilMask:front".into(), "StencilMask:back".into()]);
            reads.extend(is_glclear.then(|| "glClearStencil".into()));
            let mask =
                self.state.get("StencilMask:front").map_or(255, |mask| mask.parse::<f64>().unwrap_or(0.0) as u32);
            is_whole &= mask & 0xFF == 0xFF;
        }
        let framebuffer = self.framebuffer("DrawFramebuffer");
        is_whole &= self.attachments.range((framebuffer, 0)..=(framebuffer, u32::MAX)).all(|((_, point), at)| {
            at.is_flat && (*point <= glow::COLOR_ATTACHMENT0 || *point >= glow::DEPTH_ATTACHMENT)
        });
        Effects { writes: self.drawn("DrawFramebuffer", &aspects), kills: is_whole, reads, sets: Vec::new() }
    }

    pub(super) fn blit(&self, call: &Recorded) -> Effects {
        let mut reads = self.read_contents();
        reads.extend(self.attached("DrawFramebuffer"));
        reads.extend(self.scissor_keys());
        reads.push(format!("cap:{:04X}", glow::FRAMEBUFFER_SRGB));
        let bits = [
            (glow::COLOR_BUFFER_BIT, "color"),
            (glow::DEPTH_BUFFER_BIT, "depth"),
            (glow::STENCIL_BUFFER_BIT, "stencil"),
        ];
        let aspects: Vec<&str> =
            bits.iter().filter(|(bit, _)| call.u(8) & bit != 0).map(|(_, aspect)| *aspect).collect();
        Effects::change(self.drawn("DrawFramebuffer", &aspects), reads)
    }
}
