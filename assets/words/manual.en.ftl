# The manual: eight cards, their texts, and the labels in their drawings (src/play/menus/manual/).

card-1-title = The shadow is larger than the hole
card-1-text = The edge of the hole, the horizon, has the radius r_s. But light is caught before it would touch it: light aimed to pass the centre at less than 2.6 r_s is bent inwards and ends in the hole. No light comes to you from there. From far away the black shadow is 2.6 times as wide as the hole.
card-1-label-light = light
card-1-label-hole = hole
card-1-label-shadow = width of the shadow
card-1-label-caught = caught
card-1-label-bent = bent away

card-2-title = The far side stands above the hole
card-2-text = The disk is flat like a plate. Yet you see its far side arch over the hole: light that leaves it upwards is bent down to you. Light from its underside is bent round below the hole and shows as a thin arc under the shadow. The gas is not up there: only its light comes from there.
card-2-label-far = far side
card-2-label-near = near side
card-2-label-you = you
card-2-label-top = top
card-2-label-underside = underside
card-2-label-view = what you see

card-3-title = One side blue and bright, one red and dim
card-3-text = The gas goes round at up to half the speed of light. Where it comes towards you, its light is bluer and brighter: its waves are pushed together, and it shines mostly forwards. Where it moves away, its light is redder and dimmer. This is the Doppler effect. Gravity makes the light of all the gas a little redder still.
card-3-label-away = moves away
card-3-label-towards = comes towards you
card-3-label-you = to you
card-3-label-red = longer waves: redder, dimmer
card-3-label-blue = shorter waves: bluer, brighter

card-4-title = Two images and a ring
card-4-text = Light of one ship can reach you on both sides of the hole. So you see the ship twice. The second image is older and mostly fainter: its light went the longer way round. If the ship is exactly behind the hole, its light comes round on every side. Then you see a ring, the Einstein ring.
card-4-label-ship = ship
card-4-label-you = you
card-4-label-first = 1st image
card-4-label-second = 2nd image
card-4-label-view = what you see
card-4-label-ring = Einstein ring

card-5-title = You see the past
card-5-text = Light takes time. When it reaches you, the ship that it left has flown on. The mark “seen” is the picture: the ship as it was, where it was. The ring “now” is where the ship is at this moment by the clock T; its light from there is still on the way. Fly to “now”.
card-5-label-you = you
card-5-label-seen = seen
card-5-label-now = now
card-5-label-light = its light

card-6-title = Your clock and the far clock
card-6-text = A clock near the hole runs slower. If you stay at r = 2 r_s, yours counts 71 seconds while one far away counts 100. A fast clock runs slower, too: in orbit it loses even more. So you come home younger than those who stayed away. You yourself notice nothing: to you, your clock runs as always.
card-6-label-stays = stays in place
card-6-label-orbits = in orbit
card-6-label-far = far away
card-6-label-rate = rate of the clock

card-7-title = To fly is to fall
card-7-text = An orbit is a fall that misses the hole. Low orbits are fast, high ones slow. To go down, brake or thrust towards the hole; to go up, thrust forwards. Below 3 r_s no circle is stable: a little off, and you fall in or fly out. At 1.5 r_s only light goes in a circle.
card-7-label-high = high orbit: slow
card-7-label-low = low orbit: fast
card-7-label-brake = brake
card-7-label-stable = 3 r_s: last stable orbit
card-7-label-light = 1.5 r_s: circle of light

card-8-title = The horizon
card-8-text = There is no wall at r = r_s, and in so large a hole you feel nothing special. But light sent outwards stays there, and farther in even it falls. So you can cross, but never come back. You still see stars: their light falls in with you. The shadow ahead grows to half the sky at last.
card-8-label-time = time
card-8-label-singularity = singularity
card-8-label-horizon = horizon
card-8-label-ship = ship
card-8-label-light = outward light
card-8-label-view = ahead, at the horizon
card-8-label-shadow = shadow
