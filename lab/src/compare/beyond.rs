//! What of a verdict is beyond the limits.

use super::fault::{Fault, Kind, Limits};
use super::measure::metrics::Verdict;

impl Verdict {
    /// Whether there is anything to judge: an image of something solid, or colours that the judge knows.
    pub fn is_judged(&self, limits: &Limits) -> bool {
        limits.flip.is_some() || self.groups.iter().any(|group| group.order <= limits.orders)
    }

    /// What goes beyond the limits, in words; nothing if the picture is right.
    pub fn faults(&self, limits: &Limits) -> Vec<String> {
        self.beyond(limits).into_iter().map(|fault| fault.text).collect()
    }

    /// What goes beyond the limits, with its kind; nothing if the picture is right.
    pub fn beyond(&self, limits: &Limits) -> Vec<Fault> {
        let mut faults = Vec::new();
        let drawn = self.groups.iter().filter(|group| group.order <= limits.orders);
        for group in drawn.clone() {
            let who = format!("{} order {}", group.name, group.order);
            let d = &group.displacement;
            if d.most > limits.most {
                let text = format!("{who}: 99 % of displacements are under {:.2} px, not {}", d.most, limits.most);
                faults.push(Fault::new(Kind::Displaced, d.most, limits.most, text));
            }
            if d.max > limits.max {
                let [x, y] = d.worst;
                let text = format!("{who}: displacement up to {:.2} px (at {x}, {y}), more than {}", d.max, limits.max);
                faults.push(Fault::new(Kind::Displaced, d.max, limits.max, text));
            }
            let allowed = limits.differing(group.pixels, group.rim);
            if group.mismatched as f64 > allowed {
                let text = format!("{who}: {} pixels differ, allowed {allowed:.1}", group.mismatched);
                faults.push(Fault::new(Kind::Differ, group.mismatched as f64, allowed, text));
            }
        }
        let allowed = |touched: usize| 0.5 * limits.thin * (touched.max(1) as f64).sqrt();
        for group in drawn.clone() {
            let ([judge, shown], allowed) = (group.thin, allowed(group.touched));
            if (judge - shown).abs() > allowed {
                let who = format!("{} order {}", group.name, group.order);
                let text = format!("{who}: thin images cover {shown:.1} px, not {judge:.1} (give or take {allowed:.1})");
                faults.push(Fault::new(Kind::Thin, (judge - shown).abs(), allowed, text));
            }
        }
        let [judge, shown] = drawn.clone().fold([0.0; 2], |sum, group| [sum[0] + group.thin[0], sum[1] + group.thin[1]]);
        let allowed = allowed(drawn.map(|group| group.touched).sum());
        if (judge - shown).abs() > allowed {
            let text = format!("thin images cover {shown:.1} px together, not {judge:.1} (give or take {allowed:.1})");
            faults.push(Fault::new(Kind::Thin, (judge - shown).abs(), allowed, text));
        }
        faults.extend(self.areas.iter().filter(|area| area.order <= limits.orders).filter_map(|area| area.fault(limits)));
        faults.extend(self.lights.iter().filter(|light| light.image.1 <= limits.orders).filter_map(|light| light.fault(limits)));
        if let Some(allowed) = limits.flip
            && self.flip > allowed
        {
            let text = format!("mean FLIP is {:.4}, not {allowed:.4}: more than half a pixel's shift makes", self.flip);
            faults.push(Fault::new(Kind::Colour, self.flip, allowed, text));
        }
        // A pixel that the border of two orders runs through is judged by coverage, like that of any border.
        for (kind, count, what) in [
            (Kind::Order, self.wrong_beyond_rim, "show an order that is nowhere near"),
            (Kind::Hole, self.holes, "are holes"),
            (Kind::Lit, self.lit, "are lit where there is no light"),
        ] {
            if count > 0 {
                faults.push(Fault::new(kind, count as f64, 1.0, format!("{count} pixels {what}")));
            }
        }
        faults
    }
}
