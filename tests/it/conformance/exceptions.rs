//! Which method does not obey which law, by design, and why.

/// Names of methods; those of methods that the ladder does not have are not asked for.
const BACKWARD: &str = "backward";
const FORWARD: &str = "forward";
const DIFFUSION: &str = "diffusion";
const TRACE: &str = "trace";

const NO_REFLECTANCE: &str = "the poster's heuristics do not know reflectance: what walls send back is no part of them";
const POINT_LIKE: &str = "the poster's heuristics read every light as a point that shines evenly all around";

/// Law, method, reason. A method that obeys after all fails: exceptions do not outlive their reason.
pub const EXCEPTIONS: &[(&str, &str, &str)] = &[
    ("shares sum to the value", BACKWARD, "it adds lights up as it goes and does not tell them apart"),
    ("shares sum to the value", FORWARD, "it adds lights up as it goes and does not tell them apart"),
    ("shares sum to the value", TRACE, "the truth is one sum"),
    ("nothing outshines the light", BACKWARD, POINT_LIKE),
    ("nothing outshines the light", FORWARD, POINT_LIKE),
    (
        "statuses",
        TRACE,
        "it knows neither void nor matter: what gets no light is dark, a sensor in matter sees its inside",
    ),
    ("no light", TRACE, "it knows no void that could be unreached"),
    ("glazing", FORWARD, "it carries flux along the skeleton, where glazing takes no share"),
    ("black is direct", BACKWARD, NO_REFLECTANCE),
    ("black is direct", FORWARD, NO_REFLECTANCE),
    ("monotone", BACKWARD, NO_REFLECTANCE),
    ("monotone", FORWARD, NO_REFLECTANCE),
    ("white", BACKWARD, "without reflectance there is nothing to warn of"),
    ("white", FORWARD, "without reflectance there is nothing to warn of"),
    ("white", TRACE, "roulette ends its paths, and its warnings are of samples"),
    ("furnace", BACKWARD, NO_REFLECTANCE),
    ("furnace", FORWARD, NO_REFLECTANCE),
    ("coupled spheres", BACKWARD, NO_REFLECTANCE),
    ("coupled spheres", FORWARD, NO_REFLECTANCE),
    ("bright tube", BACKWARD, NO_REFLECTANCE),
    ("bright tube", FORWARD, NO_REFLECTANCE),
    ("grey tube", BACKWARD, NO_REFLECTANCE),
    ("grey tube", FORWARD, NO_REFLECTANCE),
    ("candid", BACKWARD, "that it knows no reflectance is what it is, not a state that a run could be in"),
    ("candid", FORWARD, "that it knows no reflectance is what it is, not a state that a run could be in"),
    ("truth", BACKWARD, NO_REFLECTANCE),
    ("truth", FORWARD, NO_REFLECTANCE),
];

/// Why the method need not obey the law of that name; `None` where it must.
pub fn exception(law: &str, method: &str) -> Option<&'static str> {
    EXCEPTIONS.iter().find(|(of, by, _)| *of == law && *by == method).map(|(.., reason)| *reason)
}
