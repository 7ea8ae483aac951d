-- Run by daws.sh, twice: "make" makes an Ardour session with the plugin on a MIDI track, sets a parameter and saves;
-- "load" loads the session and reads the parameter. The other arguments are the session's folder and the plugin's name.
local step, folder, name = arg[1], arg[2], arg[3]
local DECAY, POSITION = 7, 0.25

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
	local info = ARDOUR.LuaAPI.new_plugin_info(name, ARDOUR.PluginType.VST3)
	assert(not info:isnil(), "Ardour does not know the plugin")
	local midi, stereo = ARDOUR.ChanCount(ARDOUR.DataType("midi"), 1), ARDOUR.ChanCount(ARDOUR.DataType("audio"), 2)
	local last, normal = ARDOUR.PresentationInfo.max_order, ARDOUR.TrackMode.Normal
	session:new_midi_track(midi, stereo, true, info, nil, nil, 1, "Sprung", last, normal, true)
	local processor = processor_of(session)
	local plugin = processor:to_insert():plugin(0)
	local info = plugin:get_info()
	print(plugin:name(), plugin:parameter_count() .. " parameters", info.n_inputs:n_midi() .. " MIDI in", info.n_outputs:n_audio() .. " audio out")
	assert(ARDOUR.LuaAPI.set_processor_param(processor, DECAY, POSITION), "the parameter cannot be set")
	-- The plugin hears of it with the next block.
	sleep(1)
	session:save_state("")
else
	local session = load_session(folder, "sprung")
	assert(session, "the session does not load")
	local position = ARDOUR.LuaAPI.get_processor_param(processor_of(session), DECAY)
	print("after loading, the parameter is at " .. position)
	assert(math.abs(position - POSITION) < 1e-6, "the parameter has not come back")
end
print("passed")
quit()
