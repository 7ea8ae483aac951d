-- Run by daws.sh, twice: "make" makes an Ardour session with the plugin on a MIDI track, sets a parameter and saves;
-- "load" loads the session and reads the parameter. "outputs" plays a note on MIDI channel 3 of Sprung Multi, which is to sound
-- on its output 3 and nowhere else. The other arguments are the session's folder and the plugin's name.
local step, folder, name = arg[1], arg[2], arg[3]
local DECAY, POSITION = 7, 0.25

local function add_track(session, outputs)
	local info = ARDOUR.LuaAPI.new_plugin_info(name, ARDOUR.PluginType.VST3)
	assert(not info:isnil(), "Ardour does not know the plugin")
	local midi = ARDOUR.ChanCount(ARDOUR.DataType("midi"), 1)
	local audio = ARDOUR.ChanCount(ARDOUR.DataType("audio"), outputs)
	local last, normal = ARDOUR.PresentationInfo.max_order, ARDOUR.TrackMode.Normal
	return session:new_midi_track(midi, audio, outputs == 2, info, nil, nil, 1, name, last, normal, true)
end

local function processor_of(session)
	for route in session:get_routes():iter() do
		local processor = route:nth_plugin(0)
		if not processor:isnil() then
			return processor
		end
	end
	error("the session has no plugin")
end

if step == "make" then
	local session = create_session(folder, "sprung", 48000)
	assert(session, "no session")
	add_track(session, 2)
	local processor = processor_of(session)
	local plugin = processor:to_insert():plugin(0)
	local info = plugin:get_info()
	print(plugin:name(), plugin:parameter_count() .. " parameters", info.n_inputs:n_midi() .. " MIDI in", info.n_outputs:n_audio() .. " audio out")
	assert(ARDOUR.LuaAPI.set_processor_param(processor, DECAY, POSITION), "the parameter cannot be set")
	-- The plugin hears of it with the next block.
	sleep(1)
	session:save_state("")
elseif step == "outputs" then
	local session = create_session(folder, "sprung", 48000)
	assert(session, "no session")
	local heard = 0
	for track in add_track(session, 34):iter() do
		heard = heard + 1
		assert(track:n_outputs():n_audio() == 34, "the track has not all outputs")
		-- The plugin starts with the next block, and the meters follow it.
		sleep(1)
		local note = C.ByteVector():add({0x92, 60, 100})
		track:to_track():to_midi_track():write_immediate_event(Evoral.EventType.MIDI_EVENT, 3, note:to_array())
		sleep(1)
		-- The first meter is that of MIDI, the next two are those of the main output.
		for meter = 1, 34 do
			local level = track:peak_meter():meter_level(meter, ARDOUR.MeterType.MeterPeak)
			local is_third = meter == 7 or meter == 8
			if is_third then
				print("output 3: " .. level .. " dBFS")
			end
			assert((level > -60) == is_third, "meter " .. meter .. " shows " .. level .. " dBFS")
		end
	end
	assert(heard == 1, "Ardour has made no track")
else
	local session = load_session(folder, "sprung")
	assert(session, "the session does not load")
	local position = ARDOUR.LuaAPI.get_processor_param(processor_of(session), DECAY)
	print("after loading, the parameter is at " .. position)
	assert(math.abs(position - POSITION) < 1e-6, "the parameter has not come back")
end
print("passed")
quit()
