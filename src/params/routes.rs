//! Parameter rows of the modulation routes' amounts; the last three belong to the routes of a new patch.

macro_rules! routes {
    ({ $($before:tt)* } $next:ident $($rest:ident)*) => {
        $next! { { $($before)*
    "Routes" {
        Route1 "route1" "Route 1 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route2 "route2" "Route 2 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route3 "route3" "Route 3 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route4 "route4" "Route 4 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route5 "route5" "Route 5 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route6 "route6" "Route 6 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route7 "route7" "Route 7 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route8 "route8" "Route 8 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route9 "route9" "Route 9 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route10 "route10" "Route 10 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route11 "route11" "Route 11 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route12 "route12" "Route 12 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route13 "route13" "Route 13 amount", Percent -100.0..100.0 = 0.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route14 "route14" "Route 14 amount", Percent -100.0..100.0 = 4.166_666_5, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route15 "route15" "Route 15 amount", Percent -100.0..100.0 = 25.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
        Route16 "route16" "Route 16 amount", Percent -100.0..100.0 = -50.0, Linear, Smoothed(20), [],
            "How far the route moves its destination, in travel of that knob.";
    }
        } $($rest)* }
    };
}

pub(super) use routes;
