// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.Window;
import java.awt.event.ActionEvent;
import java.io.IOException;
import java.util.Arrays;
import java.util.Optional;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import javax.swing.JFrame;
import javax.swing.JOptionPane;
import javax.swing.SwingUtilities;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

import rhotrack.spy.scene.LcmSubscription;
import rhotrack.spy.scene.LcmUrlArgument;
import rhotrack.spy.scene.MessageDecoder;
import rhotrack.spy.scene.Model;

/**
 * The plug-in that lcm-spy finds on its class path: any channel of rhotrack opens the one viewer
 * window for all channels, beside lcm-spy's window.
 */
public final class LcmSpyPlugin implements SpyPlugin {
    private static final String SPY_TITLE = "LCM Spy";

    private ViewerWindow window;

    @Override
    public boolean canHandle(long fingerprint) {
        return MessageDecoder.canDecode(fingerprint);
    }

    @Override
    @SuppressWarnings("serial") // actions are never serialised
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new AbstractAction("rhotrack view") {
            @Override
            public void actionPerformed(ActionEvent event) {
                closeEmptyWindow(desktop, channel);
                openOrRaiseViewer();
            }
        };
    }

    /** Closes the empty window that lcm-spy creates for a plug-in's view. */
    private static void closeEmptyWindow(JDesktopPane desktop, ChannelData channel) {
        if (SwingUtilities.getWindowAncestor(desktop) instanceof JFrame frame
                && frame.getTitle().equals(channel.name) && desktop.getAllFrames().length == 0) {
            frame.dispose();
        }
    }

    private static Optional<Window> findSpyWindow() {
        return Arrays.stream(Window.getWindows())
                .filter(one -> one.isVisible() && one instanceof JFrame frame
                        && SPY_TITLE.equals(frame.getTitle()))
                .findFirst();
    }

    private void openOrRaiseViewer() {
        if (window != null && window.isOpen()) {
            window.toFront();
            return;
        }
        try {
            Model model = new Model();
            LcmSubscription feed = new LcmSubscription(LcmUrlArgument.fromThisProcess(), model);
            window = new ViewerWindow(model, feed, Viewer.WIDTH, Viewer.HEIGHT);
            findSpyWindow().ifPresent(window::placeBeside);
            window.open();
        } catch (IOException e) {
            JOptionPane.showMessageDialog(null, e.getMessage(), "rhotrack",
                    JOptionPane.ERROR_MESSAGE);
        }
    }
}
